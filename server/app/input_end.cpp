#include "server/app/input_end.hpp"

#include <fcntl.h>

#include <asio/buffer.hpp>
#include <utility>

namespace runstone {

Result<std::unique_ptr<InputEnd>, std::string> InputEnd::watch(asio::io_context& loop,
                                                               std::function<void()> on_end,
                                                               int descriptor) {
  auto out = std::make_unique<InputEnd>(loop, std::move(on_end));
  const int copy = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
  asio::error_code error;
  if (copy < 0) return failure("standard input is closed");
  out->input_.assign(copy, error);
  if (error) {
    ::close(copy);
    return failure("standard input cannot be waited for: " + error.message());
  }
  out->read();
  return out;
}

void InputEnd::read() {
  input_.async_read_some(asio::buffer(dropped_),
                         [this](const asio::error_code& error, std::size_t) {
                           if (error == asio::error::operation_aborted) return;
                           if (error) return on_end_();
                           read();
                         });
}

}  // namespace runstone
