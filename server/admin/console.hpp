// Console: commands typed into the server's own terminal, or piped into it, line by line; answers go to standard
// output. Belongs to the thread that runs the loop.
#pragma once
#include <unistd.h>

#include <array>
#include <asio/io_context.hpp>
#include <asio/posix/stream_descriptor.hpp>
#include <functional>
#include <iosfwd>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "server/rollback/command_reply.hpp"

namespace runstone {

class Console : public std::enable_shared_from_this<Console> {
 public:
  using Handler = std::function<void(const std::string& line, CommandReply reply)>;
  /// Is told, once, why nothing more is read although the input has not ended.
  using OnFailure = std::function<void(const std::string& line)>;

  /// Reads a descriptor, which stays the caller's, from now on. A line longer than a command may be is answered with a
  /// mistake and left out. Fails if the descriptor cannot be waited for, such as a plain file.
  static Result<std::shared_ptr<Console>, std::string> open(asio::io_context& loop, Handler handler,
                                                            OnFailure on_failure,
                                                            int descriptor = STDIN_FILENO,
                                                            std::ostream& out = std::cout);
  /// Reads no more. Answers that come later are still printed, as long as the loop runs.
  void close();

  Console(asio::io_context& loop, Handler handler, OnFailure on_failure, std::ostream& out)
      : loop_(loop),
        input_(loop),
        handler_(std::move(handler)),
        on_failure_(std::move(on_failure)),
        out_(out) {}

 private:
  void read();
  void take(std::string_view bytes);
  void run(const std::string& line);

  asio::io_context& loop_;
  asio::posix::stream_descriptor input_;
  Handler handler_;
  OnFailure on_failure_;
  std::ostream& out_;
  std::array<char, 4096> in_{};
  std::string line_;          // so far
  bool is_too_long_ = false;  // the line: its bytes are dropped until it ends
};

}  // namespace runstone
