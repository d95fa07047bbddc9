// Console: reads commands from the server's terminal or from a pipe, line by line, and prints the
// answers to standard output. Thread: the one that runs the loop.
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
  /// The console calls it once, with the reason, if reading fails before the end of the input.
  using OnFailure = std::function<void(const std::string& line)>;

  /// Starts reading from a copy of the descriptor. A line that is longer than a command is
  /// rejected. Fails if the descriptor cannot be waited for, such as that of a regular file.
  static Result<std::shared_ptr<Console>, std::string> open(asio::io_context& loop, Handler handler,
                                                            OnFailure on_failure,
                                                            int descriptor = STDIN_FILENO,
                                                            std::ostream& out = std::cout);
  /// Stops reading. Later answers are still printed while the loop runs.
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
  std::string line_;          // the part read so far
  bool is_too_long_ = false;  // the rest of the line is dropped
};

}  // namespace runstone
