#include "common/model_reader/model_folder.hpp"

#include <fcntl.h>
#include <linux/landlock.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

namespace runstone {
namespace {

// These numbers are those of every processor.
constexpr long kOpenat2Call = 437, kCreateRulesetCall = 444, kAddRuleCall = 445,
               kRestrictSelfCall = 446;
// Rights of files that newer kernels know, which the headers of Debian 12 do not name.
constexpr std::uint64_t kLandlockTruncate = 1ULL << 14, kLandlockDeviceControl = 1ULL << 15;

/// Opens a path below a folder, or returns -1 with errno.
int open_beneath(int folder, const std::string& path, int flags) {
  open_how how{};
  how.flags = static_cast<std::uint64_t>(flags | O_CLOEXEC);
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
  const long opened = ::syscall(kOpenat2Call, folder, path.c_str(), &how, sizeof how);
  if (opened >= 0 || (errno != ENOSYS && errno != EPERM)) return static_cast<int>(opened);
  // Older kernels, and containers that refuse calls they do not know: no symbolic link at all.
  int at = folder;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const bool is_last = end == path.size();
    const int next = ::openat(at, path.substr(begin, end - begin).c_str(),
                              O_CLOEXEC | O_NOFOLLOW | (is_last ? flags : O_PATH | O_DIRECTORY));
    const int reason = errno;
    if (at != folder) ::close(at);
    errno = reason;
    if (next < 0 || is_last) return next;
    at = next;
    begin = end + 1;
  }
}

ModelFolder::Refusal refusal_of(int reason) {
  switch (reason) {
    case EXDEV:
    case ELOOP:
      return ModelFolder::Refusal::outside;
    case ENOENT:
    case ENOTDIR:
    case ENAMETOOLONG:
      return ModelFolder::Refusal::missing;
    default:
      return ModelFolder::Refusal::unreadable;
  }
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Returns true for "C:..." and "https:...".
bool has_scheme(std::string_view path) {
  const std::size_t colon = path.find(':');
  if (colon == std::string_view::npos || colon == 0 || !is_letter(path[0])) return false;
  return std::all_of(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '+' || c == '.' || c == '-';
  });
}

}  // namespace

OpenedFile::~OpenedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::size_t OpenedFile::read(void* to, std::size_t count, std::uint64_t offset) const {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t some = ::pread(descriptor_, static_cast<char*>(to) + done, count - done,
                                 static_cast<off_t>(offset + done));
    if (some < 0 && errno == EINTR) continue;
    if (some <= 0) break;
    done += static_cast<std::size_t>(some);
  }
  return done;
}

std::string path_within(std::string_view path) {
  std::string from(path);
  std::replace(from.begin(), from.end(), '\\', '/');
  if (from.empty() || from.front() == '/' || has_scheme(from) ||
      from.find('\0') != std::string::npos)
    return {};
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= from.size();) {
    const std::size_t end = std::min(from.find('/', begin), from.size());
    const std::string_view part = std::string_view(from).substr(begin, end - begin);
    if (part == "..") {
      if (parts.empty()) return {};
      parts.pop_back();
    } else if (!part.empty() && part != ".") {
      parts.push_back(part);
    }
    begin = end + 1;
  }
  std::string within;
  for (const std::string_view part : parts) {
    if (!within.empty()) within.push_back('/');
    within.append(part);
  }
  return within;
}

Result<ModelFolder, std::string> ModelFolder::of_file(const std::string& file) {
  const std::unique_ptr<char, decltype(&std::free)> resolved(::realpath(file.c_str(), nullptr),
                                                             &std::free);
  if (!resolved) return failure(std::string(std::strerror(errno)));
  const std::string path = resolved.get();
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == 0 ? "/" : path.substr(0, slash);
  const int descriptor = ::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return failure("its folder: " + std::string(std::strerror(errno)));
  return ModelFolder(descriptor, path.substr(slash + 1));
}

ModelFolder::~ModelFolder() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool ModelFolder::confine_process() const {
  const long version = ::syscall(kCreateRulesetCall, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return false;
  landlock_ruleset_attr rules{};
  rules.handled_access_fs =
      LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_READ_FILE |
      LANDLOCK_ACCESS_FS_READ_DIR | LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE |
      LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
      LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_BLOCK |
      LANDLOCK_ACCESS_FS_MAKE_SYM;
  if (version >= 2) rules.handled_access_fs |= LANDLOCK_ACCESS_FS_REFER;
  if (version >= 3) rules.handled_access_fs |= kLandlockTruncate;
  if (version >= 5) rules.handled_access_fs |= kLandlockDeviceControl;
  const auto ruleset =
      static_cast<int>(::syscall(kCreateRulesetCall, &rules, sizeof rules.handled_access_fs, 0));
  if (ruleset < 0) return false;
  landlock_path_beneath_attr below{};
  below.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
  below.parent_fd = descriptor_;
  const bool is_confined =
      ::syscall(kAddRuleCall, ruleset, LANDLOCK_RULE_PATH_BENEATH, &below, 0) == 0 &&
      ::syscall(kRestrictSelfCall, ruleset, 0) == 0;
  ::close(ruleset);
  return is_confined;
}

Result<OpenedFile, ModelFolder::Refusal> ModelFolder::open(std::string_view path) const {
  const std::string within = path_within(path);
  if (within.empty()) return failure(Refusal::outside);
  // The kind is known before the file is opened, because opening a device can have effects.
  const int place = open_beneath(descriptor_, within, O_PATH);
  if (place < 0) return failure(refusal_of(errno));
  struct stat about{};
  const bool is_known = ::fstat(place, &about) == 0;
  ::close(place);
  if (!is_known) return failure(Refusal::unreadable);
  if (!S_ISREG(about.st_mode)) return failure(Refusal::not_a_file);
  const int descriptor = open_beneath(descriptor_, within, O_RDONLY | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return failure(refusal_of(errno));
  const bool is_still_known = ::fstat(descriptor, &about) == 0;
  OpenedFile opened(descriptor, static_cast<std::uint64_t>(about.st_size));
  if (!is_still_known) return failure(Refusal::unreadable);
  if (!S_ISREG(about.st_mode)) return failure(Refusal::not_a_file);
  return opened;
}

const char* ModelFolder::words(Refusal refusal) {
  switch (refusal) {
    case Refusal::outside:
      return "which is outside its folder";
    case Refusal::missing:
      return "which does not exist";
    case Refusal::not_a_file:
      return "which is no regular file";
    case Refusal::unreadable:
      break;
  }
  return "which cannot be read";
}

}  // namespace runstone
