#include "tests/bench/report/chart/scale.hpp"

#include <algorithm>
#include <cmath>

#include "tests/bench/report/chart/format_value.hpp"

namespace runstone::bench::chart {
namespace {

constexpr double kLargest = 1e30;
constexpr double kSmallestLog = 1e-30;
constexpr double kSteps[] = {1, 2, 5};

/// Returns the least 1, 2 or 5 times a power of ten that is not below a positive value.
double round_up(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : kSteps) {
    if (step * decade >= value * (1 - 1e-9)) return step * decade;
  }
  return 10 * decade;
}

double round_down(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  double out = decade;
  for (const double step : kSteps) {
    if (step * decade <= value * (1 + 1e-9)) out = step * decade;
  }
  return out;
}

}  // namespace

bool Scale::can_show(double value, bool is_log) {
  return is_log ? value >= kSmallestLog && value <= kLargest : std::abs(value) <= kLargest;
}

Scale::Scale(std::span<const double> values, bool is_log, Start start, Ends ends, std::size_t ticks)
    : is_log_(is_log) {
  for (const double value : values) {
    if (!can_show(value)) continue;
    low_ = has_values_ ? std::min(low_, value) : value;
    high_ = has_values_ ? std::max(high_, value) : value;
    has_values_ = true;
  }
  if (!has_values_) {
    low_ = is_log_ ? 1 : 0;
    high_ = is_log_ ? 10 : 1;
  }
  if (start == Start::bars) {
    low_ = is_log_ ? low_ * 0.7 : std::min(low_, 0.0);
    high_ = is_log_ ? high_ : std::max(high_, 0.0);
  }
  part_ends();
  ticks = std::max<std::size_t>(ticks, 2);
  if (is_log_) {
    divide_log(ends, ticks);
  } else {
    divide_linear(ends, ticks);
  }
}

/// Moves the ends of the scale apart if they are almost equal. Otherwise no step would be above the
/// precision of a double.
void Scale::part_ends() {
  constexpr double kSmallest = 1e-30;  // smaller values count as 0 on a linear scale
  const double largest = std::max(std::abs(low_), std::abs(high_));
  if (high_ - low_ > (is_log_ ? largest * 1e-9 : std::max(largest * 1e-9, kSmallest))) return;
  if (largest <= kSmallest && !is_log_) {
    low_ = 0;
    high_ = 1;
    return;
  }
  const double room = std::abs(low_) * 0.4;
  low_ -= room;
  high_ += room;
}

void Scale::add_ticks(double step) {
  ticks_.clear();
  const double last = std::floor(high_ / step + 1e-6);
  for (double at = std::ceil(low_ / step - 1e-6); at <= last; ++at) {
    ticks_.push_back({at * step, format_tick(at * step, step)});
  }
}

void Scale::divide_linear(Ends ends, std::size_t ticks) {
  const double low = low_;
  const double high = high_;
  double step = round_up((high - low) / static_cast<double>(ticks));
  // Rounding the ends to steps may add some steps. Then a larger step is used.
  for (int larger = 0; larger < 4; ++larger) {
    if (ends == Ends::round) {
      low_ = std::floor(low / step + 1e-6) * step;
      high_ = std::ceil(high / step - 1e-6) * step;
    }
    add_ticks(step);
    if (ticks_.size() <= ticks) return;
    step = round_up(step * 1.5);
  }
}

void Scale::divide_log(Ends ends, std::size_t ticks) {
  if (ends == Ends::round) {
    low_ = round_down(low_);
    high_ = round_up(high_);
  }
  const int first = static_cast<int>(std::floor(std::log10(low_) + 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(high_) + 1e-9));
  // Tries 1-2-5, then decades, then every second decade, every third, and so on.
  for (int stride = 0; stride <= last - first + 1; ++stride) {
    ticks_.clear();
    for (int decade = first; decade <= last; ++decade) {
      if (stride > 1 && decade % stride != 0) continue;
      for (const double step : kSteps) {
        const double value = step * std::pow(10.0, decade);
        const bool is_within = value >= low_ * (1 - 1e-9) && value <= high_ * (1 + 1e-9);
        if (is_within && (stride == 0 || step == 1)) ticks_.push_back({value, format_value(value)});
      }
    }
    if (ticks_.size() <= ticks) break;
  }
  // Between two of those values a logarithmic scale is nearly linear.
  if (ticks_.size() < 2)
    add_ticks(round_up((high_ - low_) / static_cast<double>(std::min<std::size_t>(ticks, 4))));
}

void Scale::lay(double from, double to) {
  from_ = from;
  to_ = to;
}

double Scale::place(double value) const {
  const double share = is_log_
                           ? (std::log(value) - std::log(low_)) / (std::log(high_) - std::log(low_))
                           : (value - low_) / (high_ - low_);
  return from_ + std::clamp(share, 0.0, 1.0) * (to_ - from_);
}

double Scale::base() const { return is_log_ ? from_ : place(std::clamp(0.0, low_, high_)); }

std::string caption_of(const Axis& axis) {
  if (!axis.is_log) return axis.title;
  return axis.title.empty() ? "log scale" : axis.title + " (log scale)";
}

}  // namespace runstone::bench::chart
