// Scale: values to positions, linear or logarithmic, with round ticks. It copes with any values.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "tests/bench/report/chart/axis.hpp"

namespace runstone::bench::chart {

struct Tick {
  double value = 0;
  std::string text = {};
};

class Scale {
 public:
  /// What the scale begins with.
  enum class Start {
    lowest,  // the lowest value
    bars  // 0; on a logarithmic scale so far below the lowest value that its bar can still be seen
  };

  enum class Ends {
    round,  // at round values, so that ticks frame the picture
    tight   // at the values themselves (or where bars start), so that they fill it
  };

  /// A scale over all values that it can show. `ticks` is the most there should be, 2 or more.
  Scale(std::span<const double> values, bool is_log, Start start, Ends ends, std::size_t ticks);

  /// Whether a value has a place: finite, and positive if logarithmic; beyond 1e30, and on a logarithmic scale below
  /// 1e-30, there is none.
  [[nodiscard]] static bool can_show(double value, bool is_log);
  [[nodiscard]] bool can_show(double value) const { return can_show(value, is_log_); }

  /// False if no value could be shown; the scale is then from 0 or 1 to 1 or 10.
  [[nodiscard]] bool has_values() const { return has_values_; }

  /// Where the ends lie; `to` may be less than `from`.
  void lay(double from, double to);

  /// Within the ends. Requires can_show(value).
  [[nodiscard]] double place(double value) const;

  /// Where bars begin: at 0 if that is within, else at the low end.
  [[nodiscard]] double base() const;

  [[nodiscard]] const std::vector<Tick>& ticks() const { return ticks_; }
  [[nodiscard]] double low() const { return low_; }
  [[nodiscard]] double high() const { return high_; }

 private:
  void part_ends();
  void divide_linear(Ends ends, std::size_t ticks);
  void divide_log(Ends ends, std::size_t ticks);
  void add_ticks(double step);

  bool is_log_;
  bool has_values_ = false;
  double low_ = 0;
  double high_ = 1;
  double from_ = 0;
  double to_ = 1;
  std::vector<Tick> ticks_;
};

/// What stands beside a scale: its title, and that it is logarithmic.
std::string caption_of(const Axis& axis);

}  // namespace runstone::bench::chart
