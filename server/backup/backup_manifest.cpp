#include "server/backup/backup_manifest.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <istream>

#include "common/core/hex.hpp"
#include "common/core/utc_text.hpp"

namespace runstone {
namespace {

static_assert(sizeof(BlockHash) == crypto_generichash_BYTES);

constexpr std::string_view kFirstLine = "runstone backup 1", kEndWord = "end ";
constexpr std::size_t kEndLineBytes = 4 + 2 * sizeof(BlockHash) + 1;
constexpr std::size_t kNameBytesMax = 255;
constexpr const char* kNotUnderstood = "is no manifest that this version understands";

ByteView bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Reads the lines of a manifest whose hash is right. After the first mistake all values are empty.
class ManifestLines {
 public:
  explicit ManifestLines(std::string_view text) : left_(text) {}

  bool at_end() const { return left_.empty(); }
  bool is_good() const { return is_good_; }
  /// Returns the rest of the next line, which must begin with `word` and a blank.
  std::string_view take(std::string_view word) {
    const std::size_t end = left_.find('\n');
    const std::string_view line = left_.substr(0, end);
    is_good_ = is_good_ && end != std::string_view::npos && line.size() > word.size() &&
               line.starts_with(word) && line[word.size()] == ' ';
    if (!is_good_) return {};
    left_.remove_prefix(end + 1);
    return line.substr(word.size() + 1);
  }
  /// Returns the number at the front of `text`, and removes it with the blank behind it.
  template <class Number>
  Number take_number(std::string_view& text) {
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    is_good_ = is_good_ && error == std::errc{};
    if (!is_good_) return 0;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.starts_with(' ')) text.remove_prefix(1);
    return number;
  }
  /// Notes whether what a line must be is true.
  void require(bool is_true) { is_good_ = is_good_ && is_true; }
  /// Returns true if the next line begins with `word`.
  bool is_next(std::string_view word) const { return left_.starts_with(word); }

 private:
  std::string_view left_;
  bool is_good_ = true;
};

/// A name that cannot lead out of the folder into which the file is restored.
bool is_plain_name(std::string_view name) {
  return !name.empty() && name.size() <= kNameBytesMax && name != "." && name != ".." &&
         name.find('/') == std::string_view::npos && name.find('\0') == std::string_view::npos;
}

/// Reads the lines between the first one and those of the files.
BackupManifest read_head(ManifestLines& lines) {
  BackupManifest out;
  lines.require(read_hex(lines.take("world"), out.world));
  std::string_view line = lines.take("taken");
  out.taken_us = lines.take_number<TimeUs>(line);
  line = lines.take("moment");
  out.epoch = lines.take_number<Epoch>(line);
  out.seq = lines.take_number<Sequence>(line);
  line = lines.take("new");
  out.new_bytes = lines.take_number<std::uint64_t>(line);
  return out;
}

/// Reads the line of a file, which its blocks follow.
BackedUpFile read_file_line(ManifestLines& lines) {
  BackedUpFile file;
  std::string_view line = lines.take("file");
  file.bytes = lines.take_number<std::uint64_t>(line);
  file.name = line;
  lines.require(is_plain_name(file.name));
  return file;
}

std::uint64_t blocks_of(std::uint64_t bytes) {
  return bytes / kBlockBytes + (bytes % kBlockBytes != 0 ? 1 : 0);
}

BackedUpFile read_backed_up_file(ManifestLines& lines) {
  BackedUpFile file = read_file_line(lines);
  while (lines.is_good() && lines.is_next("block ")) {
    BlockHash hash{};
    lines.require(read_hex(lines.take("block"), hash));
    file.blocks.push_back(hash);
  }
  lines.require(file.blocks.size() == blocks_of(file.bytes));
  return file;
}

/// Gets the lines of a manifest one after the other, and keeps what they say without the blocks.
class ManifestSizes {
 public:
  /// Takes the next line, without its end. Returns false if it cannot be in a manifest.
  bool take(std::string_view line) {
    ++lines_;
    if (lines_ <= kHeadLines) {
      head_ += line;
      head_ += '\n';
      if (lines_ < kHeadLines) return true;
      auto head = parse_manifest_head(head_);
      if (head) out_ = *head;
      return head.has_value();
    }
    if (line.starts_with("block ")) {
      BlockHash hash{};
      return blocks_left_-- > 0 && read_hex(line.substr(6), hash);
    }
    const std::string whole = std::string(line) + '\n';
    ManifestLines lines(whole);
    out_.files.push_back(read_file_line(lines));
    const bool is_good = lines.is_good() && blocks_left_ == 0;
    blocks_left_ = blocks_of(out_.files.back().bytes);
    return is_good;
  }
  bool is_complete() const { return lines_ >= kHeadLines && blocks_left_ == 0; }
  BackupManifest manifest() && { return std::move(out_); }

 private:
  static constexpr int kHeadLines = 5;
  std::uint64_t lines_ = 0, blocks_left_ = 0;  // the blocks of the last file that did not come yet
  std::string head_;
  BackupManifest out_;
};

}  // namespace

BlockHash hash_of_block(ByteView bytes) {
  static const int is_ready = ::sodium_init();  // chooses the fastest code for this processor
  static_cast<void>(is_ready);
  BlockHash hash{};
  ::crypto_generichash(hash.data(), hash.size(), bytes.data(), bytes.size(), nullptr, 0);
  return hash;
}

std::uint64_t BackupManifest::bytes() const {
  std::uint64_t all = 0;
  for (const BackedUpFile& file : files) all += file.bytes;
  return all;
}

std::string manifest_text(const BackupManifest& manifest) {
  std::string text(kFirstLine);
  text += "\nworld " + to_hex(manifest.world);
  text += "\ntaken " + std::to_string(manifest.taken_us);
  text += "\nmoment " + std::to_string(manifest.epoch) + " " + std::to_string(manifest.seq);
  text += "\nnew " + std::to_string(manifest.new_bytes) + "\n";
  for (const BackedUpFile& file : manifest.files) {
    text += "file " + std::to_string(file.bytes) + " " + file.name + "\n";
    for (const BlockHash& hash : file.blocks) text += "block " + to_hex(hash) + "\n";
  }
  const BlockHash all = hash_of_block(bytes_of(text));
  text += std::string(kEndWord) + to_hex(all) + "\n";
  return text;
}

Result<BackupManifest, std::string> parse_manifest(std::string_view text) {
  if (text.starts_with("runstone backup ") && !text.starts_with(std::string(kFirstLine) + "\n"))
    return failure("is of a newer version of Runstone");
  if (!text.starts_with(kFirstLine)) return failure("is no manifest of a backup");
  if (text.size() < kEndLineBytes) return failure("is cut off");
  const std::string_view body = text.substr(0, text.size() - kEndLineBytes);
  const std::string_view end = text.substr(body.size());
  BlockHash wanted{};
  if (!end.starts_with(kEndWord) || !end.ends_with('\n') ||
      !read_hex(end.substr(kEndWord.size(), 2 * wanted.size()), wanted))
    return failure("is cut off");
  if (hash_of_block(bytes_of(body)) != wanted) return failure("is damaged");
  ManifestLines lines(body.substr(kFirstLine.size() + 1));
  BackupManifest out = read_head(lines);
  while (lines.is_good() && !lines.at_end()) out.files.push_back(read_backed_up_file(lines));
  if (!lines.is_good()) return failure(kNotUnderstood);
  return out;
}

std::optional<BackupManifest> parse_manifest_head(std::string_view text) {
  if (!text.starts_with(std::string(kFirstLine) + "\n")) return std::nullopt;
  ManifestLines lines(text.substr(kFirstLine.size() + 1));
  BackupManifest head = read_head(lines);
  if (!lines.is_good()) return std::nullopt;
  return head;
}

Result<BackupManifest, std::string> read_manifest_sizes(std::istream& in) {
  const BlockHash nothing = hash_of_block({});  // makes the library ready
  BlockHash hash = nothing, wanted{};
  ::crypto_generichash_state hashing;
  ::crypto_generichash_init(&hashing, nullptr, 0, hash.size());
  ManifestSizes sizes;
  bool is_understood = true;
  std::array<char, 2 * kNameBytesMax> line{};  // the longest line has a name and a number
  for (bool is_first = true; in.getline(line.data(), line.size()) && !in.eof(); is_first = false) {
    const std::string_view text(line.data(), static_cast<std::size_t>(in.gcount()) - 1);
    if (is_first && text != kFirstLine) {
      return failure(text.starts_with("runstone backup ") ? "is of a newer version of Runstone"
                                                          : "is no manifest of a backup");
    }
    if (text.starts_with(kEndWord)) {
      ::crypto_generichash_final(&hashing, hash.data(), hash.size());
      if (!read_hex(text.substr(kEndWord.size()), wanted) ||
          in.peek() != std::istream::traits_type::eof())
        return failure("is cut off");
      if (hash != wanted) return failure("is damaged");
      if (!is_understood || !sizes.is_complete()) return failure(kNotUnderstood);
      return std::move(sizes).manifest();
    }
    line[text.size()] = '\n';
    const ByteView bytes = bytes_of(std::string_view(line.data(), text.size() + 1));
    ::crypto_generichash_update(&hashing, bytes.data(), bytes.size());
    is_understood = is_understood && sizes.take(text);
  }
  return failure(in.eof() ? "is cut off" : "is damaged");
}

std::string backup_name(TimeUs taken_us) {
  std::string name = utc_text(taken_us);
  std::erase_if(name, [](char c) { return c == '-' || c == ':'; });
  return name;
}

std::optional<TimeUs> time_of_backup(std::string_view name) {
  constexpr std::size_t kDigitsOfDay = 8;
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (i == 4 || i == 6) text += '-';
    if (i == kDigitsOfDay + 3 || i == kDigitsOfDay + 5) text += ':';
    text += name[i];
  }
  const auto time = parse_utc(text);
  if (!time || backup_name(*time) != name) return std::nullopt;
  return time;
}

}  // namespace runstone
