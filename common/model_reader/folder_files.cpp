#include "common/model_reader/folder_files.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

namespace runstone {
namespace {

constexpr std::size_t kRefusedMax = 16;

/// A file, or bytes in memory, or the second before a part of the first.
class FolderStream : public Assimp::IOStream {
 public:
  explicit FolderStream(OpenedFile file) : file_(std::move(file)), bytes_(file_->bytes()) {}
  explicit FolderStream(std::string_view memory) : memory_(memory), bytes_(memory.size()) {}
  /// `head` must outlive the stream. The bytes of the file follow it from `rest_at` on.
  FolderStream(std::string_view head, OpenedFile file, std::uint64_t rest_at)
      : memory_(head),
        file_(std::move(file)),
        rest_at_(rest_at),
        bytes_(head.size() + file_->bytes() - std::min(rest_at, file_->bytes())) {}

  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    if (size == 0 || count == 0 || count > std::numeric_limits<std::size_t>::max() / size) return 0;
    const std::size_t left = at_ < bytes_ ? static_cast<std::size_t>(bytes_ - at_) : 0;
    // Like fread(): only whole elements count.
    const std::size_t whole = std::min(count, left / size);
    const std::size_t got = read(static_cast<char*>(to), whole * size) / size;
    at_ += got * size;
    return got;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::uint64_t from = origin == aiOrigin_CUR ? at_ : origin == aiOrigin_END ? bytes_ : 0;
    const std::uint64_t to = from + offset;  // a negative offset wraps, as it does for Assimp
    if (to > bytes_) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return static_cast<std::size_t>(at_); }
  std::size_t FileSize() const override { return static_cast<std::size_t>(bytes_); }
  void Flush() override {}

 private:
  std::size_t read(char* to, std::size_t count) {
    std::size_t done = 0;
    if (at_ < memory_.size()) done = memory_.copy(to, count, static_cast<std::size_t>(at_));
    if (done == count || !file_) return done;
    return done + file_->read(to + done, count - done, rest_at_ + (at_ + done - memory_.size()));
  }

  std::string_view memory_;
  std::optional<OpenedFile> file_;
  std::uint64_t rest_at_ = 0;
  std::uint64_t bytes_ = 0, at_ = 0;
};

/// Returns a path in the form in which two spellings of one file are equal.
std::string plain_path(const std::string& path) {
  std::string plain = path_within(path);
  if (!plain.empty()) return plain;
  plain = path;  // it leads out of the folder
  while (plain.compare(0, 2, "./") == 0) plain.erase(0, 2);
  return plain;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

std::string last_name(const std::string& path) { return path.substr(path.find_last_of("/\\") + 1); }

std::string percent_decoded(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    if (low < 0) {
      out.push_back(text[i]);
      continue;
    }
    out.push_back(static_cast<char>(16 * high + low));
    i += 2;
  }
  return out;
}

Result<OpenedFile, ModelFolder::Refusal> FolderFiles::open(const std::string& path) const {
  auto opened = folder_.open(path);
  if (opened || opened.error() != ModelFolder::Refusal::missing) return opened;
  const std::string decoded = percent_decoded(path);
  return decoded == path ? std::move(opened) : folder_.open(decoded);
}

/// Returns true if Assimp looks for a file that it was refused before. It tries other spellings and
/// other folders, and for the materials of an .obj at last a file with the name of the model.
bool FolderFiles::is_searched(const std::string& path) const {
  const std::string plain = plain_path(path);
  const std::string& model = folder_.name();
  if (!refused_.empty() && plain == model.substr(0, model.find_last_of('.')) + ".mtl") return true;
  return std::any_of(refused_.begin(), refused_.end(), [&](const Refused& other) {
    return plain_path(other.path) == plain || last_name(other.path) == plain;
  });
}

void FolderFiles::refuse(const std::string& path, ModelFolder::Refusal why) const {
  if (!is_searched(path) && refused_.size() < kRefusedMax) refused_.push_back({path, why});
}

bool FolderFiles::Exists(const char* path) const {
  if (replaced_ && last_name(path) == kFloatsFile) return true;
  const auto opened = open(path);
  if (!opened) refuse(path, opened.error());
  return opened.has_value();
}

Assimp::IOStream* FolderFiles::Open(const char* path, const char* mode) {
  if (std::string_view(mode).find_first_of("wa+") != std::string_view::npos) return nullptr;
  if (replaced_ && last_name(path) == kFloatsFile) return new FolderStream(replaced_->floats);
  auto opened = open(path);
  if (!opened) {
    refuse(path, opened.error());
    return nullptr;
  }
  if (last_name(path) != folder_.name()) has_opened_others_ = true;
  if (replaced_ && path_within(path) == folder_.name())
    return new FolderStream(replaced_->head, *std::move(opened), replaced_->rest_at);
  return new FolderStream(*std::move(opened));  // Assimp owns it until Close()
}

void FolderFiles::Close(Assimp::IOStream* stream) { delete stream; }

}  // namespace runstone
