#include "tests/bench/report/chart/category_labels.hpp"

#include <algorithm>

#include "tests/bench/report/chart/chart_text.hpp"

namespace runstone::bench::chart {
namespace {

constexpr double kDegrees = 50;
constexpr double kSine = 0.766;
constexpr double kCosine = 0.643;
constexpr double kLongest = 130;  // units along the slant

}  // namespace

std::vector<std::size_t> panels_of(std::size_t columns, std::size_t per_panel_max) {
  const std::size_t limit = std::max<std::size_t>(per_panel_max, 1);
  const std::size_t panels = (columns + limit - 1) / limit;
  std::vector<std::size_t> out;
  out.reserve(panels);
  for (std::size_t i = 0; i < panels; ++i)
    out.push_back(columns / panels + (i < columns % panels ? 1 : 0));
  return out;
}

CategoryLabels::CategoryLabels(const std::vector<std::string>& names, double pitch)
    : names_(names) {
  double widest = 0;
  for (const std::string& name : names) widest = std::max(widest, width_of(name, kTickSize));
  is_slanted_ = widest > pitch - 6;
  height_ = is_slanted_ ? std::min(widest, kLongest) * kSine + 18 : 20;
}

double CategoryLabels::overhang(std::size_t column) const {
  const double wide = width_of(names_[column], kTickSize);
  return is_slanted_ ? std::min(wide, kLongest) * kCosine : wide / 2;
}

void CategoryLabels::draw_below(Svg& svg, std::size_t column, double x, double y) const {
  if (!is_slanted_) return svg.text(x, y + 16, Anchor::middle, names_[column], "tick");
  const double length = std::min(kLongest, (x + 2) / kCosine);
  svg.text(x + 4, y + 13, Anchor::end, shortened(names_[column], kTickSize, length), "tick",
           -kDegrees);
}

void CategoryLabels::draw_above(Svg& svg, std::size_t column, double x, double y,
                                double right) const {
  if (!is_slanted_) return svg.text(x, y - 7, Anchor::middle, names_[column], "tick");
  const double length = std::min(kLongest, (right - x - 9) / kCosine);
  svg.text(x + 3, y - 6, Anchor::start, shortened(names_[column], kTickSize, length), "tick",
           -kDegrees);
}

}  // namespace runstone::bench::chart
