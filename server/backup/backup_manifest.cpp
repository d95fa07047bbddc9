#include "server/backup/backup_manifest.hpp"

#include <sodium.h>

#include <algorithm>
#include <charconv>

#include "common/core/hex.hpp"
#include "common/core/utc_text.hpp"

namespace runstone {
namespace {

static_assert(sizeof(BlockHash) == crypto_generichash_BYTES);

constexpr std::string_view kFirstLine = "runstone backup 1", kEndWord = "end ";
constexpr std::size_t kEndLineBytes = 4 + 2 * sizeof(BlockHash) + 1;
constexpr std::size_t kNameBytesMax = 255;

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

BackedUpFile read_backed_up_file(ManifestLines& lines) {
  BackedUpFile file;
  std::string_view line = lines.take("file");
  file.bytes = lines.take_number<std::uint64_t>(line);
  file.name = line;
  lines.require(is_plain_name(file.name));
  while (lines.is_good() && lines.is_next("block ")) {
    BlockHash hash{};
    lines.require(read_hex(lines.take("block"), hash));
    file.blocks.push_back(hash);
  }
  lines.require(file.blocks.size() == file.bytes / kBlockBytes + (file.bytes % kBlockBytes != 0));
  return file;
}

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
  BackupManifest out;
  lines.require(read_hex(lines.take("world"), out.world));
  std::string_view line = lines.take("taken");
  out.taken_us = lines.take_number<TimeUs>(line);
  line = lines.take("moment");
  out.epoch = lines.take_number<Epoch>(line);
  out.seq = lines.take_number<Sequence>(line);
  line = lines.take("new");
  out.new_bytes = lines.take_number<std::uint64_t>(line);
  while (lines.is_good() && !lines.at_end()) out.files.push_back(read_backed_up_file(lines));
  if (!lines.is_good()) return failure("is no manifest that this version understands");
  return out;
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
