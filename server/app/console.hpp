// Console: commands typed into the server's own terminal, or piped into it, line by line; answers go to standard
// output. Belongs to the thread that runs the loop.
#pragma once
#include <asio/io_context.hpp>
#include <asio/posix/stream_descriptor.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/core/result.hpp"
#include "server/rollback/rollback_desk.hpp"

namespace runstone {

class Console : public std::enable_shared_from_this<Console> {
 public:
  using Handler = std::function<void(const std::string& line, DeskReply reply)>;

  /// Reads standard input from now on. Fails if it cannot be waited for, such as a plain file.
  static Result<std::shared_ptr<Console>, std::string> open(asio::io_context& loop, Handler handler);
  /// Reads no more. Answers that come later are still printed, as long as the loop runs.
  void close();

  Console(asio::io_context& loop, Handler handler)
      : loop_(loop), input_(loop), handler_(std::move(handler)) {}

 private:
  void read();

  asio::io_context& loop_;
  asio::posix::stream_descriptor input_;
  Handler handler_;
  std::string in_;
};

}  // namespace runstone
