#include "server/app/console.hpp"

#include <unistd.h>

#include <asio/post.hpp>
#include <asio/read_until.hpp>
#include <csignal>
#include <iostream>

#include "protocol/limits.hpp"

namespace runstone {

Result<std::shared_ptr<Console>, std::string> Console::open(asio::io_context& loop, Handler handler) {
  // A server that was put into the background must not be halted because somebody types into the shell.
  std::signal(SIGTTIN, SIG_IGN);
  auto console = std::make_shared<Console>(loop, std::move(handler));
  asio::error_code error;
  console->input_.assign(::dup(STDIN_FILENO), error);
  if (error) return Unexpected<std::string>{"console: standard input: " + error.message()};
  console->read();
  return console;
}

void Console::close() {
  asio::error_code ignored;
  input_.close(ignored);
}

void Console::read() {
  asio::async_read_until(input_, asio::dynamic_buffer(in_, kCommandBytesMax + 1), '\n',
                         [self = shared_from_this()](const asio::error_code& error, std::size_t bytes) {
                           if (error) return;  // the end, a line without end, or in the background
                           const std::string line = self->in_.substr(0, bytes - 1);
                           self->in_.erase(0, bytes);
                           const auto print = [self](const DeskAnswer& answer) {
                             asio::post(self->loop_,
                                        [self, text = answer.text] { std::cout << text << std::endl; });
                           };
                           if (line.find_first_not_of(' ') != std::string::npos) self->handler_(line, print);
                           self->read();
                         });
}

}  // namespace runstone
