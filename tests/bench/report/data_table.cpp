#include "tests/bench/report/data_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace runstone::bench {
namespace {

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string field(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

void add_line(const auto& values, std::string& out) {
  bool is_first = true;
  for (const auto& value : values) {
    if (!std::exchange(is_first, false)) out += ',';
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, DataTable::Value>) {
      out += std::visit([](const auto& v) { return field(v); }, value);
    } else {
      out += field(value);
    }
  }
  out += "\r\n";
}

}  // namespace

std::string csv_of(const DataTable& table) {
  std::string out;
  add_line(table.columns, out);
  for (const auto& row : table.rows) add_line(row, out);
  return out;
}

}  // namespace runstone::bench
