// DataTable: the numbers of a figure, as CSV for spreadsheets.
#pragma once
#include <string>
#include <variant>
#include <vector>

namespace runstone::bench {

struct DataTable {
  using Value = std::variant<std::string, double>;
  std::vector<std::string> columns;
  std::vector<std::vector<Value>> rows;

  void add(std::vector<Value> row) { rows.push_back(std::move(row)); }
};

/// Returns a line of names, then a line for each row, in the form of RFC 4180. A missing value
/// (NaN) is an empty field.
std::string csv_of(const DataTable& table);

}  // namespace runstone::bench
