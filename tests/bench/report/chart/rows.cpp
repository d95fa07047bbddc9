#include "tests/bench/report/chart/rows.hpp"

#include <algorithm>

#include "tests/bench/report/chart/chart_text.hpp"
#include "tests/bench/report/chart/plot.hpp"

namespace runstone::bench::chart {
namespace {

constexpr double kMargin = 4;
constexpr double kNameGap = 10;
constexpr double kSlack = 1;             // rounding must not shorten the widest name
constexpr double kNamesShareMax = 0.36;  // of the chart's width

}  // namespace

Rows::Rows(const std::vector<std::string>& names, const std::vector<Role>& roles, double tail,
           Width width)
    : names_(names),
      roles_(roles),
      is_narrow_(width == Width::narrow),
      end_(width_of(width) - kMargin) {
  left_ = kMargin;
  if (!is_narrow_) {
    double widest = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
      widest = std::max(widest, width_of(names[i], kTextSize) * (is_strong(i) ? kStrong : 1));
    }
    left_ += std::min(widest, kNamesShareMax * width_of(width)) + kSlack + kNameGap;
  }
  right_ = std::max(end_ - tail, left_ + (end_ - left_) * 0.4);
}

double Rows::bar_top(std::size_t row) const {
  return top_ + static_cast<double>(row) * pitch() + (is_narrow_ ? 17 : 4);
}

double Rows::bar_height() const { return is_narrow_ ? 13 : 16; }

double Rows::bottom() const { return top_ + static_cast<double>(names_.size()) * pitch() + 4; }

void Rows::draw_name(Svg& svg, std::size_t row, double reserved) const {
  const char* const weight = is_strong(row) ? "strong" : "plain";
  const double size = kTextSize * (is_strong(row) ? kStrong : 1);
  if (is_narrow_) {
    const std::string name = shortened(names_[row], size, end_ - left_ - reserved);
    return svg.text(left_, bar_top(row) - 5, Anchor::start, name, weight);
  }
  const std::string name = shortened(names_[row], size, left_ - kNameGap - kMargin);
  svg.text(left_ - kNameGap, bar_middle(row) + 4, Anchor::end, name, weight);
}

void Rows::draw_axis(Svg& svg, const Scale& scale, const std::string& caption) const {
  svg.text(left_, top_ - 28, Anchor::start, shortened(caption, kTextSize, end_ - left_), "quiet");
  draw_tick_row(svg, scale, top_ - 8, end_);
  for (const Tick& tick : scale.ticks()) {
    const double x = scale.place(tick.value);
    svg.line(x, top_ - 2, x, bottom(), "grid");
  }
}

}  // namespace runstone::bench::chart
