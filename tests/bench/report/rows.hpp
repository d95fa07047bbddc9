// Rows: the flat rows of a finding, picked by the values of their columns. Missing columns and values that are
// no numbers read as "not measured" (NaN), so that a result of another version never breaks the page.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace runstone::bench {

/// Points into the JSON it was made from.
class Rows {
 public:
  Rows() = default;
  /// The objects of an array; none of anything else.
  explicit Rows(const nlohmann::json& array);

  /// One row: an object. None of anything else.
  static Rows of(const nlohmann::json& object);

  Rows where(std::string_view column, std::string_view text) const;
  Rows where(std::string_view column, double number) const;

  void add(const Rows& rows) { rows_.insert(rows_.end(), rows.rows_.begin(), rows.rows_.end()); }
  bool empty() const { return rows_.empty(); }
  std::size_t size() const { return rows_.size(); }
  Rows operator[](std::size_t row) const;

  /// Of the first row; NaN if there is none.
  double number(std::string_view column) const;
  /// Of the first row; empty if there is none.
  std::string text(std::string_view column) const;
  /// One a row.
  std::vector<double> numbers(std::string_view column) const;
  /// The different texts of a column, in the order in which they come.
  std::vector<std::string> kinds(std::string_view column) const;

 private:
  std::vector<const nlohmann::json*> rows_;
};

/// Of the values that were measured; NaN if none was. The geometric mean leaves out what is not positive.
double mean_of(const std::vector<double>& values);
double geometric_mean_of(const std::vector<double>& values);
double sum_of(const std::vector<double>& values);

}  // namespace runstone::bench
