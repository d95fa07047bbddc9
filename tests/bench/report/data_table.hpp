// DataTable: the numbers behind a figure, as CSV that a spreadsheet reads.
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

/// A line of names, then one a row, after RFC 4180. What was not measured (NaN) is an empty field.
std::string csv_of(const DataTable& table);

}  // namespace runstone::bench
