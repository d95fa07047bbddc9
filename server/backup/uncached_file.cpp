#include "server/backup/uncached_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace runstone {
namespace {

Unexpected<std::string> system_failure(const std::string& file, const char* verb) {
  return failure(file + ": cannot be " + verb + ": " + std::generic_category().message(errno));
}

}  // namespace

Result<UncachedFile, std::string> UncachedFile::make(const std::string& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) return system_failure(file, "made");
  return UncachedFile(file, descriptor);
}

UncachedFile::~UncachedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void, std::string> UncachedFile::reserve(std::uint64_t bytes) {
  // The size must stay 0: SQLite takes a file of zeros for a damaged database.
  const int done = ::fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(bytes));
  if (done != 0 && (errno == ENOSPC || errno == EDQUOT)) return system_failure(file_, "written");
  return {};
}

Result<void, std::string> UncachedFile::flush() {
  if (::fdatasync(descriptor_) != 0) return system_failure(file_, "synced");
  static_cast<void>(::posix_fadvise(descriptor_, 0, 0, POSIX_FADV_DONTNEED));
  return {};
}

}  // namespace runstone
