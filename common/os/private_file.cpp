#include "common/os/private_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace runstone {
namespace {

using Written = Result<void, std::string>;

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

/// Closes a descriptor at the end of its scope.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  ~OpenFile() { ::close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

 private:
  int descriptor_;
};

/// Puts the name of a renamed file on disk. A file system that cannot is no error.
void sync_folder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(::fsync(descriptor));
  ::close(descriptor);
}

}  // namespace

bool make_private_folder(const std::string& folder) {
  if (folder.empty() || ::access(folder.c_str(), F_OK) == 0) return true;
  return make_private_folder(std::filesystem::path(folder).parent_path().string()) &&
         (::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST);
}

Written write_private_file(const std::string& file, std::string_view bytes) {
  const auto fail = [&file](int error) {
    return Written(failure(file + ": cannot be written: " + std::strerror(error)));
  };
  const std::string folder = std::filesystem::absolute(file).parent_path().string();
  if (!make_private_folder(folder)) return fail(errno);
  const std::string fresh = file + ".new";
  ::unlink(fresh.c_str());  // of a crash; it may have another mode
  const int descriptor = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) return fail(errno);
  errno = 0;
  const bool is_written = write_all(descriptor, bytes) && ::fsync(descriptor) == 0;
  const int error = errno;
  const bool is_closed = ::close(descriptor) == 0;
  if (!is_written || !is_closed || ::rename(fresh.c_str(), file.c_str()) != 0) {
    const int why = is_written ? errno : error;
    ::unlink(fresh.c_str());
    return fail(why);
  }
  sync_folder(folder);
  return {};
}

Result<std::string, std::string> read_file(const std::string& file, std::size_t bytes_max) {
  const auto fail = [&file](const std::string& why) { return failure(file + ": " + why); };
  const auto cannot = [&fail](int error) {
    return fail(std::string("cannot be read: ") + std::strerror(error));
  };
  // Without O_NONBLOCK the call would wait for the other end of a FIFO.
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return cannot(errno);
  const OpenFile closes(descriptor);
  struct stat about {};
  if (::fstat(descriptor, &about) != 0) return cannot(errno);
  if (S_ISDIR(about.st_mode)) return fail("is a folder");
  if (!S_ISREG(about.st_mode)) return fail("is a device, a pipe or a socket, and no file");
  const std::string too_large = "is larger than " + std::to_string(bytes_max) + " bytes";
  if (static_cast<std::uint64_t>(about.st_size) > bytes_max) return fail(too_large);
  // The file may grow while it is read, and files of /proc have no size.
  std::string bytes;
  std::array<char, 64 * 1024> part{};
  for (;;) {
    const ssize_t count = ::read(descriptor, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return cannot(errno);
    if (count == 0) return bytes;
    bytes.append(part.data(), static_cast<std::size_t>(count));
    if (bytes.size() > bytes_max) return fail(too_large);
  }
}

std::string set_aside(const std::string& file) {
  const std::string broken = file + ".broken";
  return ::rename(file.c_str(), broken.c_str()) == 0 ? broken : std::string();
}

}  // namespace runstone
