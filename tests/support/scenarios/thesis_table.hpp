// The thesis' tables in tests/data/thesis: a line of column names, then rows of values. A value in
// quotes may contain commas.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace runstone::test {

/// One row by column name; an empty field is an empty string.
using ThesisRow = std::map<std::string, std::string>;

/// Returns all rows of tests/data/thesis/`file`. Aborts the test program if there is no such file,
/// or if a row has fewer or more fields than the first line.
std::vector<ThesisRow> thesis_table(const std::string& file);

/// Returns the whole text of tests/data/thesis/`file`.
std::string thesis_text(const std::string& file);

}  // namespace runstone::test
