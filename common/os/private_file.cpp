#include "common/os/private_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "common/os/file_writer.hpp"

namespace runstone {
namespace {

using Written = Result<void, std::string>;

/// Returns why a file of this mode is not read, or an empty text.
std::string words_of_mode(mode_t mode, FileKinds kinds) {
  if (S_ISDIR(mode)) return "is a folder";
  if (S_ISREG(mode) || (kinds == FileKinds::regular_or_pipe && S_ISFIFO(mode))) return {};
  return "is a device, a pipe or a socket, and no file";
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

/// A `Container` of bytes: std::string or Bytes.
template <class Container>
Result<Container, std::string> read_whole(const std::string& file, std::size_t bytes_max,
                                          FileKinds kinds) {
  const auto fail = [&file](const std::string& why) { return failure(file + ": " + why); };
  const auto cannot = [&fail](int error) {
    return fail(std::string("cannot be read: ") + std::strerror(error));
  };
  // Without O_NONBLOCK the call would wait for the other end of a FIFO.
  const int waits = kinds == FileKinds::regular_or_pipe ? 0 : O_NONBLOCK;
  const int descriptor = ::open(file.c_str(), O_RDONLY | waits | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return cannot(errno);
  const OpenFile closes(descriptor);
  struct stat about{};
  if (::fstat(descriptor, &about) != 0) return cannot(errno);
  if (const std::string words = words_of_mode(about.st_mode, kinds); !words.empty())
    return fail(words);
  const std::string too_large = "is larger than " + std::to_string(bytes_max) + " bytes";
  if (static_cast<std::uint64_t>(about.st_size) > bytes_max) return fail(too_large);
  // The file may grow while it is read, and files of /proc have no size.
  Container bytes;
  bytes.reserve(static_cast<std::size_t>(about.st_size));
  std::array<char, 64 * 1024> part{};
  for (;;) {
    const ssize_t count = ::read(descriptor, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return cannot(errno);
    if (count == 0) return bytes;
    const std::size_t filled = bytes.size();
    bytes.resize(filled + static_cast<std::size_t>(count));
    std::memcpy(bytes.data() + filled, part.data(), static_cast<std::size_t>(count));
    if (bytes.size() > bytes_max) return fail(too_large);
  }
}

}  // namespace

bool make_private_folder(const std::string& folder) {
  if (folder.empty() || ::access(folder.c_str(), F_OK) == 0) return true;
  return make_private_folder(std::filesystem::path(folder).parent_path().string()) &&
         (::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST);
}

Written write_private_file(const std::string& file, std::string_view bytes) {
  const auto fail = [&file](const std::string& why) {
    return Written(failure(file + ": cannot be written: " + why));
  };
  const std::string folder = std::filesystem::absolute(file).parent_path().string();
  if (!make_private_folder(folder)) return fail(std::strerror(errno));
  auto out = FileWriter::replace(file, 0600);
  if (!out) return fail(out.error());
  out->write(bytes);
  if (const auto done = out->finish(); !done) return fail(done.error());
  return {};
}

Result<std::string, std::string> read_file(const std::string& file, std::size_t bytes_max,
                                           FileKinds kinds) {
  return read_whole<std::string>(file, bytes_max, kinds);
}

Result<Bytes, std::string> read_file_bytes(const std::string& file, std::size_t bytes_max,
                                           FileKinds kinds) {
  return read_whole<Bytes>(file, bytes_max, kinds);
}

Written check_file_kind(const std::string& file, FileKinds kinds) {
  struct stat about{};
  if (::stat(file.c_str(), &about) != 0)
    return failure(file + ": cannot be read: " + std::strerror(errno));
  const std::string words = words_of_mode(about.st_mode, kinds);
  if (!words.empty()) return failure(file + ": " + words);
  return {};
}

std::string set_aside(const std::string& file) {
  const std::string broken = file + ".broken";
  return ::rename(file.c_str(), broken.c_str()) == 0 ? broken : std::string();
}

}  // namespace runstone
