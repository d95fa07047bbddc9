#include "tests/bench/report/rows.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "tests/bench/harness/statistics.hpp"

namespace runstone::bench {
namespace {

using nlohmann::json;

double number_of(const json& row, std::string_view column) {
  const auto found = row.find(column);
  if (found == row.end()) return kNoNumber;
  if (found->is_number()) return found->get<double>();
  if (found->is_boolean()) return found->get<bool>() ? 1 : 0;
  return kNoNumber;
}

std::string text_of(const json& row, std::string_view column) {
  const auto found = row.find(column);
  return found != row.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Returns the values without missing ones.
std::vector<double> measured(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  return values;
}

}  // namespace

Rows::Rows(const json& array) {
  if (!array.is_array()) return;
  for (const json& row : array) {
    if (row.is_object()) rows_.push_back(&row);
  }
}

Rows Rows::of(const json& object) {
  Rows out;
  if (object.is_object()) out.rows_.push_back(&object);
  return out;
}

Rows Rows::where(std::string_view column, std::string_view text) const {
  Rows out = *this;
  std::erase_if(out.rows_, [&](const json* row) { return text_of(*row, column) != text; });
  return out;
}

Rows Rows::where(std::string_view column, double number) const {
  Rows out = *this;
  std::erase_if(out.rows_, [&](const json* row) { return number_of(*row, column) != number; });
  return out;
}

Rows Rows::operator[](std::size_t row) const {
  Rows out;
  if (row < rows_.size()) out.rows_.push_back(rows_[row]);
  return out;
}

double Rows::number(std::string_view column) const {
  return rows_.empty() ? kNoNumber : number_of(*rows_.front(), column);
}

std::string Rows::text(std::string_view column) const {
  return rows_.empty() ? std::string() : text_of(*rows_.front(), column);
}

std::vector<double> Rows::numbers(std::string_view column) const {
  std::vector<double> out;
  for (const json* row : rows_) out.push_back(number_of(*row, column));
  return out;
}

std::vector<std::string> Rows::kinds(std::string_view column) const {
  std::vector<std::string> out;
  for (const json* row : rows_) {
    std::string kind = text_of(*row, column);
    if (std::find(out.begin(), out.end(), kind) == out.end()) out.push_back(std::move(kind));
  }
  return out;
}

double sum_of(const std::vector<double>& values) {
  const auto known = measured(values);
  return known.empty() ? kNoNumber : std::accumulate(known.begin(), known.end(), 0.0);
}

double mean_of(const std::vector<double>& values) {
  const auto known = measured(values);
  return known.empty() ? kNoNumber : sum_of(known) / static_cast<double>(known.size());
}

double geometric_mean_of(const std::vector<double>& values) {
  auto known = measured(values);
  std::erase_if(known, [](double value) { return value <= 0; });
  return known.empty() ? kNoNumber : geometric_mean(known);
}

}  // namespace runstone::bench
