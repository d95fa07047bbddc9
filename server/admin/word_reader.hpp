// WordReader: reads the words of a command one after another and keeps the first error. An error
// names the wrong word and what is allowed in its place.
#pragma once
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Splits one line into words. Blanks separate words; a word that contains blanks stands in double
/// quotes. Fails if the line is longer than kCommandBytesMax, is not printable UTF-8, or lacks a
/// quote.
Result<std::vector<std::string>, std::string> command_words(std::string_view line);

/// Returns the number that the whole text is, or nullopt.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Returns the number that the whole text is in hexadecimal digits, or nullopt.
std::optional<std::uint64_t> hex_number_of(std::string_view text);

class WordReader {
 public:
  /// A line whose first `next` words name the command: reading begins after them. `words` must
  /// outlive the reader. `now_us` (UTC) is the time to which ages and durations refer. `text`: the
  /// rest of the line, for a command that takes it as it was typed.
  WordReader(const std::vector<std::string>& words, std::size_t next, TimeUs now_us,
             std::string_view text = {});

  /// Returns the words that name the command: "rollback preview".
  const std::string& command() const { return command_; }
  std::string_view text() const { return text_; }
  TimeUs now_us() const { return now_us_; }

  /// Returns true after the last word, and after an error.
  bool at_end() const { return next_ == words_.size() || !error_.empty(); }
  /// Returns the next word. Requires that there is one.
  const std::string& peek() const { return words_[next_]; }
  /// Returns true if a word comes after the next one, and peek_second() that word.
  bool has_second() const { return error_.empty() && next_ + 1 < words_.size(); }
  const std::string& peek_second() const { return words_[next_ + 1]; }
  /// Takes the next word if it is `word`. Returns true if it was.
  bool take_word(std::string_view word);
  /// Returns the next word. If there is none, returns an empty word and records an error.
  std::string take(const std::string& after, const std::string& what);
  /// Returns the next word if it is the last one. Otherwise records the error "COMMAND: `rule`".
  std::string take_only(const std::string& rule);
  /// Records an error, unless there is one.
  void wrong(std::string line);
  /// Records an error if a word is left. `after` is the part of the command that is complete.
  void expect_end(const std::string& after);

  /// Takes a moment: an age or a time in UTC. `word` is the word before it.
  TimeUs moment(const std::string& word);
  /// Takes a duration. Returns the time at which it ends if it begins now.
  TimeUs end_of_duration(const std::string& word);
  /// Takes a whole number of this range.
  std::int64_t number(const std::string& word, std::int64_t min, std::int64_t max);
  /// Takes the coordinates of a voxel.
  VoxelPos position(const std::string& word);
  /// Takes two opposite corners, both inside.
  VoxelBox box(const std::string& word);
  /// Takes a box(), or `columns` and x and z of two opposite corners.
  VoxelBox ground(const std::string& word);
  /// Takes a player: a name, an author number, a key or a fingerprint. Nobody is looked up.
  std::string player(const std::string& word);
  /// Takes a name of a role or of a protected box.
  std::string rights_name(const std::string& word);
  /// Takes the words `reason TEXT` if they come next. Otherwise returns an empty text.
  std::string reason();

  /// Returns the first error, or an empty text.
  const std::string& error() const { return error_; }
  /// Returns what the words mean, or the first error with `before` in front of it.
  template <class Meaning>
  Result<Meaning, std::string> result(Meaning meaning, const std::string& before = "") const {
    if (!error_.empty()) return failure(before + error_);
    return meaning;
  }

 private:
  /// Takes a coordinate of a voxel. `word` names the place, `missing` what is expected there.
  std::int32_t coordinate(const std::string& word, const std::string& missing);

  const std::vector<std::string>& words_;
  std::string command_;
  std::size_t next_;
  TimeUs now_us_;
  std::string_view text_;
  std::string error_;
};

/// The forms of a word for a player.
inline constexpr const char* kPlayerWord = "a name, # and a number, a key or a fingerprint";
/// Returns the names of all rights: "see, build, ...".
std::string all_right_names();

}  // namespace runstone
