// Names below or above columns, upright where they fit, otherwise slanted; and the number of
// columns side by side.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

/// The least distance between slanted names.
constexpr double kSlantedPitch = 17;

/// Returns the column counts of the fewest panels that `per_panel_max` allows, as equal as
/// possible: 37 and 20 give 19 and 18.
std::vector<std::size_t> panels_of(std::size_t columns, std::size_t per_panel_max);

class CategoryLabels {
 public:
  CategoryLabels(const std::vector<std::string>& names, double pitch);

  /// Returns the units from the columns to the far end of the names.
  [[nodiscard]] double height() const { return height_; }

  /// Returns the units by which a name below its column extends to the left of the column's middle.
  [[nodiscard]] double overhang(std::size_t column) const;

  /// Draws a name below the columns, centred under `x`, the middle of the column, or ending there.
  /// `y` is the end of the columns.
  void draw_below(Svg& svg, std::size_t column, double x, double y) const;

  /// Draws a name above the columns, rising to the right, but not beyond `right`.
  void draw_above(Svg& svg, std::size_t column, double x, double y, double right) const;

 private:
  const std::vector<std::string>& names_;
  bool is_slanted_ = false;
  double height_ = 0;
};

}  // namespace runstone::bench::chart
