// Rows: the flat rows of a finding, selected by the values of their columns. Missing columns and
// values that are no numbers read as "not measured" (NaN), so that a result of another version
// never breaks the page.
#pragma once
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace runstone::bench {

/// Stands for a number that was not measured.
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// An object refers to the JSON from which it was made, which must outlive it.
class Rows {
 public:
  Rows() = default;
  /// Takes the objects of an array as rows. Anything else gives no rows.
  explicit Rows(const nlohmann::json& array);

  /// Returns one row for an object, and no row for anything else.
  static Rows of(const nlohmann::json& object);

  Rows where(std::string_view column, std::string_view text) const;
  Rows where(std::string_view column, double number) const;

  void add(const Rows& rows) { rows_.insert(rows_.end(), rows.rows_.begin(), rows.rows_.end()); }
  bool empty() const { return rows_.empty(); }
  std::size_t size() const { return rows_.size(); }
  Rows operator[](std::size_t row) const;

  /// Returns a value of the first row; NaN if there is no row.
  double number(std::string_view column) const;
  /// Returns a text of the first row; empty if there is no row.
  std::string text(std::string_view column) const;
  /// Returns one value for each row.
  std::vector<double> numbers(std::string_view column) const;
  /// Returns the different texts of a column, in order of appearance.
  std::vector<std::string> kinds(std::string_view column) const;

 private:
  std::vector<const nlohmann::json*> rows_;
};

/// Returns the mean of the known values; NaN if there are none. The geometric mean leaves out
/// values that are not positive.
double mean_of(const std::vector<double>& values);
double geometric_mean_of(const std::vector<double>& values);
double sum_of(const std::vector<double>& values);

}  // namespace runstone::bench
