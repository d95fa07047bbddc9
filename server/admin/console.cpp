#include "server/admin/console.hpp"

#include <algorithm>
#include <asio/buffer.hpp>
#include <asio/error.hpp>
#include <asio/post.hpp>
#include <csignal>
#include <ostream>

#include "common/os/text_file.hpp"
#include "protocol/limits.hpp"

namespace runstone {

Result<std::shared_ptr<Console>, std::string> Console::open(asio::io_context& loop, Handler handler,
                                                            OnFailure on_failure, int descriptor,
                                                            std::ostream& out) {
  // Without this, a read of the terminal from the background would stop the process.
  std::signal(SIGTTIN, SIG_IGN);
  auto console = std::make_shared<Console>(loop, std::move(handler), std::move(on_failure), out);
  asio::error_code error;
  console->input_.assign(::dup(descriptor), error);
  if (error) return failure("console: standard input: " + error.message());
  console->read();
  return console;
}

void Console::close() {
  asio::error_code ignored;
  input_.close(ignored);
}

void Console::read() {
  input_.async_read_some(asio::buffer(in_), [self = shared_from_this()](
                                                const asio::error_code& error, std::size_t bytes) {
    if (error == asio::error::operation_aborted || !self->input_.is_open()) return;
    if (error == asio::error::eof) {
      // The last line may be incomplete, and a part of a command can be another command. So it is
      // not carried out.
      if (!self->line_.empty())
        self->out_ << "the last line has no end, and is left out" << std::endl;
      return;
    }
    if (error) {  // EIO: the terminal is closed, or this process is in its background
      return self->on_failure_("console: standard input cannot be read any more: " +
                               error.message());
    }
    self->take(std::string_view(self->in_.data(), bytes));
    self->read();
  });
}

void Console::take(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    const bool ends = end != std::string_view::npos;
    const std::string_view part = bytes.substr(0, end);
    bytes.remove_prefix(ends ? end + 1 : bytes.size());
    if (!is_too_long_ && line_.size() + part.size() > kCommandBytesMax) {
      is_too_long_ = true;
      line_.clear();
      out_ << "a command has at most " << kCommandBytesMax << " bytes: this line is left out"
           << std::endl;
    }
    if (!is_too_long_) line_ += part;
    if (!ends) continue;
    trim_line(line_);
    if (line_.find_first_not_of(' ') != std::string::npos) run(line_);
    line_.clear();
    is_too_long_ = false;
  }
}

void Console::run(const std::string& line) {
  handler_(line, [self = shared_from_this()](const CommandAnswer& answer) {
    asio::post(self->loop_, [self, text = answer.text] { self->out_ << text << std::endl; });
  });
}

}  // namespace runstone
