#include "server/store/writer_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace runstone {

StoreResult<WriterLock> WriterLock::take(const std::string& folder, const std::string& file) {
  const std::string path = folder + "/world.lock";
  WriterLock lock;
  lock.descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock.descriptor_ < 0) {
    return Unexpected<StoreError>{{StoreError::Kind::io, path, "",
                                   "cannot be written: " + std::generic_category().message(errno)}};
  }
  // flock, not fcntl: it belongs to the open file, so a second Store of this process is refused as well.
  if (::flock(lock.descriptor_, LOCK_EX | LOCK_NB) != 0) {
    return Unexpected<StoreError>{{StoreError::Kind::locked, file, "",
                                   "another program is writing this world (it holds world.lock)"}};
  }
  return lock;
}

WriterLock& WriterLock::operator=(WriterLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

WriterLock::~WriterLock() {
  // The file stays: removing it would let two writers lock two different files of the same name.
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace runstone
