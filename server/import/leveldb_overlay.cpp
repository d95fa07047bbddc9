#include "server/import/leveldb_overlay.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>
#include <utility>

namespace runstone {
namespace {

using leveldb::Slice;
using leveldb::Status;

Status system_failure(const std::string& file, int error) {
  const char* const what = std::strerror(error);
  return error == ENOENT ? Status::NotFound(file, what) : Status::IOError(file, what);
}

/// A regular file of the folder, open for reading.
class SourceFile {
 public:
  static Status open(const std::string& file, SourceFile& out) {
    // A pipe would block without O_NONBLOCK.
    out.descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (out.descriptor_ < 0) return system_failure(file, errno);
    struct stat facts{};
    if (::fstat(out.descriptor_, &facts) != 0) return system_failure(file, errno);
    if (!S_ISREG(facts.st_mode)) return Status::IOError(file, "is no regular file");
    out.file_ = file;
    return Status::OK();
  }
  SourceFile() = default;
  SourceFile(SourceFile&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), file_(std::move(other.file_)) {}
  SourceFile& operator=(SourceFile&&) = delete;
  ~SourceFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  /// Reads up to `count` bytes; fewer at the end of the file.
  Status read(std::uint64_t at, std::size_t count, Slice* out, char* buffer) const {
    std::size_t done = 0;
    while (done < count) {
      if (at + done > static_cast<std::uint64_t>(std::numeric_limits<off_t>::max())) break;
      const ssize_t got =
          ::pread(descriptor_, buffer + done, count - done, static_cast<off_t>(at + done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return system_failure(file_, errno);
      if (got == 0) break;
      done += static_cast<std::size_t>(got);
    }
    *out = Slice(buffer, done);
    return Status::OK();
  }

 private:
  int descriptor_ = -1;
  std::string file_;
};

class SequentialSource final : public leveldb::SequentialFile {
 public:
  explicit SequentialSource(SourceFile file) : file_(std::move(file)) {}
  Status Read(std::size_t count, Slice* out, char* buffer) override {
    const Status done = file_.read(at_, count, out, buffer);
    if (done.ok()) at_ += out->size();
    return done;
  }
  Status Skip(std::uint64_t count) override {
    at_ += count;
    return Status::OK();
  }

 private:
  SourceFile file_;
  std::uint64_t at_ = 0;
};

class RandomSource final : public leveldb::RandomAccessFile {
 public:
  explicit RandomSource(SourceFile file) : file_(std::move(file)) {}
  Status Read(std::uint64_t at, std::size_t count, Slice* out, char* buffer) const override {
    return file_.read(at, count, out, buffer);
  }

 private:
  SourceFile file_;
};

/// Bytes that the database wrote. It writes a file to its end before it reads it.
class WrittenSource final : public leveldb::RandomAccessFile, public leveldb::SequentialFile {
 public:
  explicit WrittenSource(std::shared_ptr<const std::string> content)
      : content_(std::move(content)) {}
  Status Read(std::uint64_t at, std::size_t count, Slice* out, char* buffer) const override {
    const std::size_t first =
        static_cast<std::size_t>(std::min<std::uint64_t>(at, content_->size()));
    const std::size_t some = std::min(count, content_->size() - first);
    std::copy_n(content_->data() + first, some, buffer);
    *out = Slice(buffer, some);
    return Status::OK();
  }
  Status Read(std::size_t count, Slice* out, char* buffer) override {
    const Status done = std::as_const(*this).Read(at_, count, out, buffer);
    at_ += out->size();
    return done;
  }
  Status Skip(std::uint64_t count) override {
    at_ += count;
    return Status::OK();
  }

 private:
  std::shared_ptr<const std::string> content_;
  std::uint64_t at_ = 0;
};

/// The shared lock of a folder, or none if the folder has no file for it.
class SharedLock final : public leveldb::FileLock {
 public:
  explicit SharedLock(int descriptor) : descriptor_(descriptor) {}
  SharedLock(const SharedLock&) = delete;
  SharedLock& operator=(const SharedLock&) = delete;
  ~SharedLock() override {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

 private:
  int descriptor_;
};

}  // namespace

class LeveldbOverlay::MemoryFile final : public leveldb::WritableFile {
 public:
  MemoryFile(LeveldbOverlay& overlay, Content content)
      : overlay_(overlay), content_(std::move(content)) {}
  Status Append(const Slice& bytes) override {
    return overlay_.append(*content_, bytes.data(), bytes.size());
  }
  Status Close() override { return Status::OK(); }
  Status Flush() override { return Status::OK(); }
  Status Sync() override { return Status::OK(); }

 private:
  LeveldbOverlay& overlay_;
  Content content_;
};

LeveldbOverlay::LeveldbOverlay(std::size_t written_max)
    : EnvWrapper(leveldb::Env::Default()), room_(written_max) {}

LeveldbOverlay::~LeveldbOverlay() = default;

void LeveldbOverlay::freeze() {
  decltype(waiting_) waiting;
  {
    const std::lock_guard lock(mutex_);
    is_frozen_ = true;
    waiting.swap(waiting_);
  }
  for (const auto& [work, argument] : waiting) target()->Schedule(work, argument);
}

LeveldbOverlay::Content LeveldbOverlay::written(const std::string& file) const {
  const std::lock_guard lock(mutex_);
  const auto found = written_.find(file);
  return found == written_.end() ? nullptr : found->second;
}

bool LeveldbOverlay::is_removed(const std::string& file) const {
  const std::lock_guard lock(mutex_);
  return removed_.contains(file);
}

Status LeveldbOverlay::append(std::string& content, const char* bytes, std::size_t count) {
  const std::lock_guard lock(mutex_);
  if (is_frozen_) return Status::IOError("opened for reading only");
  if (count > room_) return Status::IOError("its log has more rows than memory is taken for");
  room_ -= count;
  content.append(bytes, count);
  return Status::OK();
}

Status LeveldbOverlay::NewSequentialFile(const std::string& file, leveldb::SequentialFile** out) {
  *out = nullptr;
  if (auto content = written(file)) {
    *out = new WrittenSource(std::move(content));
    return Status::OK();
  }
  if (is_removed(file)) return system_failure(file, ENOENT);
  SourceFile source;
  if (Status opened = SourceFile::open(file, source); !opened.ok()) return opened;
  *out = new SequentialSource(std::move(source));
  return Status::OK();
}

Status LeveldbOverlay::NewRandomAccessFile(const std::string& file,
                                           leveldb::RandomAccessFile** out) {
  *out = nullptr;
  if (auto content = written(file)) {
    *out = new WrittenSource(std::move(content));
    return Status::OK();
  }
  if (is_removed(file)) return system_failure(file, ENOENT);
  SourceFile source;
  if (Status opened = SourceFile::open(file, source); !opened.ok()) return opened;
  *out = new RandomSource(std::move(source));
  return Status::OK();
}

Status LeveldbOverlay::NewWritableFile(const std::string& file, leveldb::WritableFile** out) {
  *out = nullptr;
  const std::lock_guard lock(mutex_);
  if (is_frozen_) return Status::IOError(file, "opened for reading only");
  auto content = std::make_shared<std::string>();
  written_[file] = content;
  *out = new MemoryFile(*this, std::move(content));
  return Status::OK();
}

Status LeveldbOverlay::NewAppendableFile(const std::string& file, leveldb::WritableFile** out) {
  *out = nullptr;
  return Status::NotSupported(file, "opened for reading only");
}

bool LeveldbOverlay::FileExists(const std::string& file) {
  std::error_code error;
  return written(file) != nullptr || (!is_removed(file) && std::filesystem::exists(file, error));
}

Status LeveldbOverlay::GetChildren(const std::string& folder, std::vector<std::string>* out) {
  out->clear();
  std::error_code error;
  std::filesystem::directory_iterator at(folder, error);
  const std::lock_guard lock(mutex_);
  for (const std::filesystem::directory_iterator end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (!removed_.contains(folder + '/' + name) && !written_.contains(folder + '/' + name))
      out->push_back(name);
  }
  if (error) return system_failure(folder, error.value());
  for (const auto& [file, content] : written_) {
    if (file.starts_with(folder + '/')) out->push_back(file.substr(folder.size() + 1));
  }
  return Status::OK();
}

Status LeveldbOverlay::RemoveFile(const std::string& file) {
  const std::lock_guard lock(mutex_);
  written_.erase(file);
  removed_.insert(file);
  return Status::OK();
}

Status LeveldbOverlay::CreateDir(const std::string&) { return Status::OK(); }
Status LeveldbOverlay::RemoveDir(const std::string&) { return Status::OK(); }

Status LeveldbOverlay::GetFileSize(const std::string& file, std::uint64_t* out) {
  *out = 0;
  if (const auto content = written(file)) {
    *out = content->size();
    return Status::OK();
  }
  if (is_removed(file)) return system_failure(file, ENOENT);
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  if (error) return system_failure(file, error.value());
  *out = bytes;
  return Status::OK();
}

Status LeveldbOverlay::RenameFile(const std::string& from, const std::string& to) {
  if (written(from) == nullptr) {
    // The only file of the folder that LevelDB renames is its log for people, which nobody reads
    // here.
    return FileExists(from) ? RemoveFile(from) : system_failure(from, ENOENT);
  }
  const std::lock_guard lock(mutex_);
  auto moved = written_.extract(from);
  written_[to] = std::move(moved.mapped());
  return Status::OK();
}

Status LeveldbOverlay::LockFile(const std::string& file, leveldb::FileLock** out) {
  *out = nullptr;
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor >= 0) {
    auto lock = std::make_unique<SharedLock>(descriptor);
    struct flock wanted{};
    wanted.l_type = F_RDLCK;
    wanted.l_whence = SEEK_SET;
    // A file system without locks has no other process that holds one.
    if (::fcntl(descriptor, F_SETLK, &wanted) != 0 && (errno == EACCES || errno == EAGAIN)) {
      is_in_use_ = true;
      return Status::IOError(file, "another program holds the lock");
    }
    *out = lock.release();
    return Status::OK();
  }
  *out = new SharedLock(-1);
  return Status::OK();
}

Status LeveldbOverlay::UnlockFile(leveldb::FileLock* lock) {
  delete lock;
  return Status::OK();
}

void LeveldbOverlay::Schedule(void (*work)(void*), void* argument) {
  {
    const std::lock_guard lock(mutex_);
    if (!is_frozen_) {
      waiting_.emplace_back(work, argument);
      return;
    }
  }
  target()->Schedule(work, argument);
}

Status LeveldbOverlay::NewLogger(const std::string& file, leveldb::Logger** out) {
  *out = nullptr;
  return Status::NotSupported(file, "no log is kept");
}

}  // namespace runstone
