#include "client/app/recorded_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace runstone {
namespace {

/// An open file, closed with it.
class InFile {
 public:
  explicit InFile(const std::string& name) : descriptor_(::open(name.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~InFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  InFile(const InFile&) = delete;
  InFile& operator=(const InFile&) = delete;
  bool is_open() const { return descriptor_ >= 0; }

  /// As RlogSource.
  std::optional<std::size_t> read(std::uint64_t position, std::span<std::uint8_t> out) const {
    std::size_t got = 0;
    while (got < out.size()) {
      const ssize_t done =
          ::pread(descriptor_, out.data() + got, out.size() - got, static_cast<off_t>(position + got));
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) return std::nullopt;
      if (done == 0) break;
      got += static_cast<std::size_t>(done);
    }
    return got;
  }

 private:
  int descriptor_;
};

}  // namespace

Result<RecordedLog, std::string> read_recorded_file(const std::string& file) {
  const InFile in(file);
  if (!in.is_open()) return Unexpected<std::string>{file + ": cannot be read: " + std::strerror(errno)};
  auto log = read_recorded_log(
      [&in](std::uint64_t position, std::span<std::uint8_t> out) { return in.read(position, out); });
  if (!log) return Unexpected<std::string>{file + ": " + log.error()};
  return log;
}

}  // namespace runstone
