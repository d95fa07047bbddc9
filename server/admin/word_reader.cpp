#include "server/admin/word_reader.hpp"

#include <algorithm>
#include <array>

#include "common/core/text.hpp"
#include "common/core/utc_text.hpp"
#include "common/rights/rights_change.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

constexpr const char* kMoment =
    "how long ago (90s, 15m, 2h30m, 2d, 1w) or when (2026-11-21T23:57:42Z, in UTC)";
constexpr const char* kDuration = "how long (90s, 15m, 2h30m, 2d, 1w)";

}  // namespace

Result<std::vector<std::string>, std::string> command_words(std::string_view line) {
  if (line.size() > kCommandBytesMax)
    return failure("a command has at most " + std::to_string(kCommandBytesMax) + " bytes");
  if (!is_printable_utf8(line)) return failure("a command is printable UTF-8 text");
  std::vector<std::string> words;
  for (std::size_t at = 0; at < line.size();) {
    if (line[at] == ' ') {
      ++at;
      continue;
    }
    const bool is_quoted = line[at] == '"';
    const std::size_t first = is_quoted ? at + 1 : at;
    const std::size_t end = std::min(line.find(is_quoted ? '"' : ' ', first), line.size());
    if (is_quoted && end == line.size()) return failure("a \" is missing at the end");
    words.emplace_back(line.substr(first, end - first));
    at = end + 1;
  }
  return words;
}

std::optional<std::uint64_t> hex_number_of(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, 16);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::string all_right_names() {
  std::string list;
  for (std::size_t i = 0; i < kRightCount; ++i)
    list += (i == 0 ? "" : ", ") + std::string(name_of(static_cast<Right>(i)));
  return list;
}

WordReader::WordReader(const std::vector<std::string>& words, std::size_t next, TimeUs now_us,
                       std::string_view text)
    : words_(words), next_(next), now_us_(now_us), text_(text) {
  for (std::size_t i = 0; i < next; ++i) command_ += (i == 0 ? "" : " ") + words[i];
}

bool WordReader::take_word(std::string_view word) {
  if (at_end() || peek() != word) return false;
  ++next_;
  return true;
}

std::string WordReader::take(const std::string& after, const std::string& what) {
  if (next_ < words_.size()) return words_[next_++];
  wrong(after + ": " + what + " is missing");
  return {};
}

std::string WordReader::take_only(const std::string& rule) {
  if (next_ + 1 == words_.size()) return words_[next_++];
  wrong(command_ + ": " + rule);
  return {};
}

void WordReader::wrong(std::string line) {
  if (error_.empty()) error_ = std::move(line);
}

void WordReader::expect_end(const std::string& after) {
  if (!at_end()) wrong(after + " \"" + peek() + "\": nothing comes after it");
}

TimeUs WordReader::moment(const std::string& word) {
  const std::string text = take(word, kMoment);
  if (const auto ago = parse_duration(text)) return now_us_ - *ago;
  if (const auto at = parse_utc(text)) return *at;
  wrong(word + " \"" + text + "\": " + kMoment);
  return 0;
}

TimeUs WordReader::end_of_duration(const std::string& word) {
  const std::string text = take(word, kDuration);
  const auto duration = parse_duration(text);
  if (duration && *duration > 0) return now_us_ + *duration;
  wrong(word + " \"" + text + "\": " + kDuration);
  return 0;
}

std::int64_t WordReader::number(const std::string& word, std::int64_t min, std::int64_t max) {
  const std::string range = "a number from " + std::to_string(min) + " to " + std::to_string(max);
  const std::string text = take(word, range);
  const auto number = number_of<std::int64_t>(text);
  if (number && *number >= min && *number <= max) return *number;
  wrong(word + " \"" + text + "\": " + range);
  return min;
}

std::int32_t WordReader::coordinate(const std::string& word, const std::string& missing) {
  const std::string text = take(word, missing);
  const auto number = number_of<std::int32_t>(text);
  if (number && *number >= -kWorldLimit && *number < kWorldLimit) return *number;
  wrong(word + " \"" + text + "\": a whole number from " + std::to_string(-kWorldLimit) + " to " +
        std::to_string(kWorldLimit - 1));
  return 0;
}

VoxelBox WordReader::box(const std::string& word) {
  std::array<std::int32_t, 6> c{};
  for (std::int32_t& value : c) {
    value =
        coordinate(word, "six numbers: x y z of one corner and of the opposite one, both inside");
  }
  return {{std::min(c[0], c[3]), std::min(c[1], c[4]), std::min(c[2], c[5])},
          {std::max(c[0], c[3]) + 1, std::max(c[1], c[4]) + 1, std::max(c[2], c[5]) + 1}};
}

VoxelPos WordReader::position(const std::string& word) {
  constexpr const char* kThree = "three numbers: x y z of a voxel";
  VoxelPos at;
  at.x = coordinate(word, kThree);
  at.y = coordinate(word, kThree);
  at.z = coordinate(word, kThree);
  return at;
}

VoxelBox WordReader::ground(const std::string& word) {
  if (!take_word("columns")) return box(word);
  constexpr const char* kFour =
      "four numbers: x z of one corner and of the opposite one, both inside";
  std::int32_t c[4] = {};
  for (std::int32_t& value : c) value = coordinate("columns", kFour);
  return columns(std::min(c[0], c[2]), std::min(c[1], c[3]), std::max(c[0], c[2]) + 1,
                 std::max(c[1], c[3]) + 1);
}

std::string WordReader::player(const std::string& word) {
  std::string player = take(word, kPlayerWord);
  if (player.empty()) wrong(word + " \"\": " + kPlayerWord);
  if (player.starts_with('#') && !number_of<AuthorId>(std::string_view(player).substr(1)))
    wrong(word + " \"" + player + "\": a number comes after #");
  return player;
}

std::string WordReader::rights_name(const std::string& word) {
  const std::string rule = "a name of a-z, 0-9, \"_\", \"-\" and \".\", at most " +
                           std::to_string(kRightsNameBytesMax) + " characters";
  std::string name = take(word, rule);
  if (!is_rights_name(name)) wrong(word + " \"" + name + "\": " + rule);
  return name;
}

std::string WordReader::reason() {
  if (!take_word("reason")) return {};
  std::string reason = take("reason", "a text, in quotes if it has blanks,");
  if (reason.size() > kReasonBytesMax) {
    wrong("reason: at most " + std::to_string(kReasonBytesMax) + " bytes, not " +
          std::to_string(reason.size()));
  }
  return reason;
}

}  // namespace runstone
