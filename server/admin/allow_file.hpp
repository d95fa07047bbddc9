// Allow files: lists of players who may join, as hosts keep them for other servers. Three forms are
// read: names, one a line; tables as CSV; and a JSON list of objects with a `name`.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

inline constexpr std::size_t kAllowFileBytesMax = std::size_t{1} << 20;
inline constexpr std::size_t kAllowEntriesMax = 2'000;

struct AllowEntry {
  std::size_t number = 0;  // of the line, or of the entry of a JSON list, from 1
  std::string name;        // the text of the file without blanks at its ends; not checked
  std::string fault;       // the reason why the entry has no name; empty: it has one
  friend bool operator==(const AllowEntry&, const AllowEntry&) = default;
};

struct AllowList {
  std::vector<AllowEntry> entries;
  const char* unit = "line";  // what the numbers of the entries count
};

/// Reads the entries of a text:
///   - JSON, if its first character is "[" or "{": a list of objects, each with a text `name`;
///   - CSV, if `is_csv`: fields separated by commas or semicolons. A field may stand in double
///     quotes. The names stand in the column with the head `name` or `username`, otherwise in the
///     first one;
///   - otherwise names, one a line. Empty lines and those that begin with "#" are left out.
/// Fails if a JSON text is invalid or is no list, or if there are more than kAllowEntriesMax
/// entries. Cost: O(bytes).
Result<AllowList, std::string> parse_allow_list(std::string_view text, bool is_csv);

/// Reads a file as parse_allow_list() does, with is_csv if its name ends with .csv. Blocks on the
/// disk.
Result<AllowList, std::string> read_allow_file(const std::string& file);

}  // namespace runstone
