#include "common/os/file_writer.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>

namespace runstone {
namespace {

constexpr int kLinksMax = 40;   // the kernel's limit
constexpr int kNamesMax = 100;  // of new files; a program that was killed leaves one behind

Unexpected<std::string> system_error(int error) { return failure(std::strerror(error)); }

/// Returns N for /dev/fd/N and the other names of a descriptor of this process, or nullopt.
std::optional<int> own_descriptor(const std::string& file) {
  if (file == "/dev/stdout") return STDOUT_FILENO;
  if (file == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!file.starts_with(folder)) continue;
    int number = -1;
    const char* const end = file.data() + file.size();
    const auto [rest, wrong] = std::from_chars(file.data() + folder.size(), end, number);
    if (wrong == std::errc() && rest == end) return number;
  }
  return std::nullopt;
}

}  // namespace

bool is_own_descriptor(const std::string& file) { return own_descriptor(file).has_value(); }

void sync_folder_of(const std::string& file) {
  const std::string folder = std::filesystem::absolute(file).parent_path().string();
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(::fsync(descriptor));
  ::close(descriptor);
}

std::string without_links(const std::string& path) {
  std::filesystem::path at = path;
  std::error_code ignored;
  for (int i = 0; i < kLinksMax && std::filesystem::is_symlink(at, ignored); ++i) {
    const auto target = std::filesystem::read_symlink(at, ignored);
    at = target.is_absolute() ? target : at.parent_path() / target;
  }
  return at.string();
}

Result<FileWriter, std::string> FileWriter::replace(const std::string& file, mode_t mode) {
  const std::string target = without_links(file);
  struct stat old{};
  const bool is_there = ::stat(target.c_str(), &old) == 0;
  for (int i = 0; i < kNamesMax; ++i) {
    const std::string fresh = target + ".new" + (i == 0 ? "" : std::to_string(i));
    const int descriptor = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor < 0) return system_error(errno);
    struct stat made{};
    if (is_there && ::fstat(descriptor, &made) == 0)
      static_cast<void>(::fchmod(descriptor, made.st_mode & old.st_mode & 0777));
    return FileWriter(descriptor, target, fresh);
  }
  return failure("too many files are called " + target + ".new");
}

Result<FileWriter, std::string> FileWriter::in_place(const std::string& file) {
  if (const auto own = own_descriptor(file)) {
    const int copy = ::fcntl(*own, F_DUPFD_CLOEXEC, 0);
    if (copy < 0) return system_error(errno);
    return FileWriter(copy, file, "");
  }
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0 && errno == ENXIO) return failure("nobody reads it");
  if (descriptor < 0) return system_error(errno);
  const int flags = ::fcntl(descriptor, F_GETFL);
  if (flags < 0 || ::fcntl(descriptor, F_SETFL, flags & ~O_NONBLOCK) != 0) {
    const int error = errno;
    ::close(descriptor);
    return system_error(error);
  }
  return FileWriter(descriptor, file, "");
}

FileWriter::~FileWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!fresh_.empty()) ::unlink(fresh_.c_str());
}

bool FileWriter::write(ByteView bytes) {
  while (!bytes.empty() && error_.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      error_ = count < 0 ? std::strerror(errno) : "nothing was written";
    } else {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
  }
  return error_.empty();
}

bool FileWriter::write(std::string_view text) {
  return write(ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

Result<void, std::string> FileWriter::finish() {
  const bool replaces = !fresh_.empty();
  if (error_.empty() && replaces && ::fsync(descriptor_) != 0) error_ = std::strerror(errno);
  if (::close(std::exchange(descriptor_, -1)) != 0 && error_.empty()) error_ = std::strerror(errno);
  if (error_.empty() && replaces && ::rename(fresh_.c_str(), file_.c_str()) != 0)
    error_ = std::strerror(errno);
  if (!error_.empty()) return failure(error_);
  if (replaces) sync_folder_of(file_);
  fresh_.clear();
  return {};
}

}  // namespace runstone
