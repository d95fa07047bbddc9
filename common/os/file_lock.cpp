#include "common/os/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace runstone {

Result<FileLock, FileLockError> FileLock::take(const std::string& file) {
  const auto lock_failure = [](bool is_held) {
    return failure(FileLockError{is_held, std::generic_category().message(errno)});
  };
  FileLock lock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (lock.descriptor_ < 0) return lock_failure(false);
  // A lock of flock() belongs to the open file, one of fcntl() to the process: only the former
  // refuses a second lock of this process.
  if (::flock(lock.descriptor_, LOCK_EX | LOCK_NB) != 0) return lock_failure(errno == EWOULDBLOCK);
  return lock;
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace runstone
