#include "server/backup/block_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "common/core/hex.hpp"
#include "common/os/folder_entries.hpp"

namespace runstone {
namespace {

constexpr std::string_view kUnfinished = ".new";

/// Closes a descriptor of a file.
class BlockDescriptor {
 public:
  BlockDescriptor(const std::string& file, int flags)
      : descriptor_(::open(file.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, 0600)) {}
  ~BlockDescriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  BlockDescriptor(const BlockDescriptor&) = delete;
  BlockDescriptor& operator=(const BlockDescriptor&) = delete;
  int get() const { return descriptor_; }

 private:
  const int descriptor_;
};

Unexpected<std::string> block_failure(const std::string& file, const char* verb) {
  const bool is_full = errno == ENOSPC || errno == EDQUOT;
  return failure(file + ": cannot be " + verb + ": " + std::generic_category().message(errno) +
                 (is_full ? ": `runstone-server backup prune` removes older backups" : ""));
}

/// Returns the bytes of a file, at most one more than a block has, or nullopt with errno.
std::optional<Bytes> read_block(const std::string& file) {
  const BlockDescriptor opened(file, O_RDONLY);
  if (opened.get() < 0) return std::nullopt;
  Bytes bytes(kBlockBytes + 1);
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t count = ::read(opened.get(), bytes.data() + filled, bytes.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::nullopt;
    if (count == 0) break;
    filled += static_cast<std::size_t>(count);
  }
  bytes.resize(filled);
  // A backup reads each block once, so it must not displace pages of the world.
  static_cast<void>(::posix_fadvise(opened.get(), 0, 0, POSIX_FADV_DONTNEED));
  return bytes;
}

Result<void, std::string> write_block(const std::string& file, ByteView block) {
  const BlockDescriptor opened(file, O_WRONLY | O_CREAT | O_TRUNC);
  if (opened.get() < 0) return block_failure(file, "made");
  while (!block.empty()) {
    const ssize_t count = ::write(opened.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return block_failure(file, "written");
    block = block.subspan(static_cast<std::size_t>(count));
  }
  if (::fdatasync(opened.get()) != 0) return block_failure(file, "synced");
  static_cast<void>(::posix_fadvise(opened.get(), 0, 0, POSIX_FADV_DONTNEED));
  return {};
}

bool make_folder(const std::string& folder) {
  return ::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST;
}

}  // namespace

Result<void, std::string> sync_names(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return block_failure(folder, "synced");
  const bool is_synced = ::fsync(descriptor) == 0;
  const int wrong = errno;
  ::close(descriptor);
  errno = wrong;
  if (!is_synced) return block_failure(folder, "synced");
  return {};
}

std::string BlockFolder::folder_of(const std::string& name) const {
  return folder_ + "/" + name.substr(0, 2);
}

Result<BlockFolder::Stored, std::string> BlockFolder::put(ByteView block) {
  Stored stored{hash_of_block(block), 0};
  const std::string name = to_hex(stored.hash);
  const std::string file = folder_of(name) + "/" + name;
  const auto there = read_block(file);
  if (there && std::ranges::equal(*there, block)) {
    // Its name may not be on disk yet: the program that wrote it may have been killed before
    // sync().
    written_.insert(folder_of(name));
    return stored;
  }
  if (!make_folder(folder_)) return block_failure(folder_, "made");
  if (!make_folder(folder_of(name))) return block_failure(folder_of(name), "made");
  const std::string fresh = file + std::string(kUnfinished);
  auto written = write_block(fresh, block);
  if (written && ::rename(fresh.c_str(), file.c_str()) != 0) written = block_failure(file, "made");
  if (!written) {
    ::unlink(fresh.c_str());
    return failure(written.error());
  }
  written_.insert(folder_of(name));
  stored.written = block.size();
  return stored;
}

Result<void, std::string> BlockFolder::sync() {
  if (written_.empty()) return {};
  for (const std::string& folder : written_) {
    if (auto synced = sync_names(folder); !synced) return synced;
  }
  written_.clear();
  return sync_names(folder_);
}

Result<Bytes, std::string> BlockFolder::get(const BlockHash& hash, std::size_t bytes) const {
  const std::string name = to_hex(hash);
  const std::string file = folder_of(name) + "/" + name;
  auto block = read_block(file);
  if (!block) return block_failure(file, "read");
  if (block->size() != bytes || hash_of_block(*block) != hash)
    return failure(file + ": is damaged: its bytes are not those of its name");
  return *std::move(block);
}

Result<std::uint64_t, std::string> BlockFolder::keep_only(const std::set<BlockHash>& used) const {
  namespace fs = std::filesystem;
  std::uint64_t freed = 0;
  std::error_code ignored;
  const auto kind = fs::symlink_status(folder_, ignored);
  if (!fs::exists(kind)) return freed;
  if (fs::is_symlink(kind)) {
    return failure(folder_ +
                   ": is a symbolic link, so no block is removed: the other folder may "
                   "hold files of others");
  }
  const auto parts = folder_entries(folder_);
  if (!parts) return failure(parts.error());
  for (const fs::path& part : *parts) {
    if (!fs::is_directory(fs::symlink_status(part, ignored))) continue;
    const auto files = folder_entries(part.string());
    if (!files) return failure(files.error());
    for (const fs::path& file : *files) {
      std::string name = file.filename().string();
      const bool is_unfinished = name.ends_with(kUnfinished);
      if (is_unfinished) name.resize(name.size() - kUnfinished.size());
      BlockHash hash{};
      if (!read_hex(name, hash) || part != folder_of(name) ||
          !fs::is_regular_file(fs::symlink_status(file, ignored)))
        continue;
      if (!is_unfinished && used.contains(hash)) continue;
      const std::uint64_t bytes = fs::file_size(file, ignored);
      if (!fs::remove(file, ignored) || ignored)
        return failure(file.string() + ": cannot be removed: " + ignored.message());
      freed += bytes;
    }
  }
  return freed;
}

}  // namespace runstone
