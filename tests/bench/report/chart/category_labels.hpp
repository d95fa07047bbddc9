// Names below or above columns: upright where they fit, else slanted; and how many columns go side by side.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

/// The least distance between slanted names.
constexpr double kSlantedPitch = 17;

/// Column counts of as few panels as `per_panel_max` allows, as equal as can be: 37 and 20 give 19 and 18.
std::vector<std::size_t> panels_of(std::size_t columns, std::size_t per_panel_max);

class CategoryLabels {
 public:
  CategoryLabels(const std::vector<std::string>& names, double pitch);

  /// Units from the columns to the far end of the names.
  [[nodiscard]] double height() const { return height_; }

  /// Units that a name below its column goes to the left of the column's middle.
  [[nodiscard]] double overhang(std::size_t column) const;

  /// Below the columns, centred under `x`, the middle of the column, or ending there; `y` is the columns' end.
  void draw_below(Svg& svg, std::size_t column, double x, double y) const;

  /// Likewise above them, rising to the right, but not beyond `right`.
  void draw_above(Svg& svg, std::size_t column, double x, double y, double right) const;

 private:
  const std::vector<std::string>& names_;
  bool is_slanted_ = false;
  double height_ = 0;
};

}  // namespace runstone::bench::chart
