// Scale: maps values to positions, linear or logarithmic, with round ticks. It accepts any values.
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
  /// The value with which the scale begins.
  enum class Start {
    lowest,  // the lowest value
    // 0; on a logarithmic scale so far below the lowest value that its bar can still be seen.
    bars
  };

  enum class Ends {
    round,  // at round values, so that ticks frame the chart
    tight   // at the values themselves (or where bars start), so that they fill the chart
  };

  /// Makes a scale over all values that it can show. `ticks` is the greatest number of ticks, 2 or
  /// more.
  Scale(std::span<const double> values, bool is_log, Start start, Ends ends, std::size_t ticks);

  /// Returns true if a value has a position: it is finite, and positive if the scale is
  /// logarithmic. Values beyond 1e30 have none, and on a logarithmic scale values below 1e-30.
  [[nodiscard]] static bool can_show(double value, bool is_log);
  [[nodiscard]] bool can_show(double value) const { return can_show(value, is_log_); }

  /// Returns false if no value could be shown. The scale is then from 0 or 1 to 1 or 10.
  [[nodiscard]] bool has_values() const { return has_values_; }

  /// Sets the positions of the ends; `to` may be less than `from`.
  void lay(double from, double to);

  /// Returns a position within the ends. Requires can_show(value).
  [[nodiscard]] double place(double value) const;

  /// Returns where bars begin: at 0 if that is within the scale, otherwise at the low end.
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

/// Returns the text beside a scale: its title, and "logarithmic" if it is.
std::string caption_of(const Axis& axis);

}  // namespace runstone::bench::chart
