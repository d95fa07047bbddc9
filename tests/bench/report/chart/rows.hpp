// Rows: the shared part of charts of horizontal bars. Names stand left of their bars, in a narrow
// chart above them.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/chart/role.hpp"
#include "tests/bench/report/chart/scale.hpp"
#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

class Rows {
 public:
  /// `roles` may be shorter than `names`. `tail` is the room for the values behind the longest bar.
  Rows(const std::vector<std::string>& names, const std::vector<Role>& roles, double tail,
       Width width);

  /// Sets the place of the first row, which is known when the head is drawn.
  void begin_at(double top) { top_ = top; }

  [[nodiscard]] bool is_narrow() const { return is_narrow_; }
  [[nodiscard]] double left() const { return left_; }    // of the bars
  [[nodiscard]] double right() const { return right_; }  // of the longest bar
  [[nodiscard]] double end() const { return end_; }      // of the chart
  [[nodiscard]] double bar_top(std::size_t row) const;
  [[nodiscard]] double bar_height() const;
  [[nodiscard]] double bar_middle(std::size_t row) const { return bar_top(row) + bar_height() / 2; }
  [[nodiscard]] double bottom() const;

  /// Draws a name, in bold for the product. In a narrow chart `reserved` units at the end of the
  /// line stay free.
  void draw_name(Svg& svg, std::size_t row, double reserved = 0) const;

  /// Draws ticks, grid lines and, above them, the caption.
  void draw_axis(Svg& svg, const Scale& scale, const std::string& caption) const;

  /// The room that draw_axis() needs above the first row.
  static constexpr double kAxisHeight = 42;

 private:
  [[nodiscard]] double pitch() const { return is_narrow_ ? 37 : 24; }

  [[nodiscard]] bool is_strong(std::size_t row) const {
    return row < roles_.size() && roles_[row] == Role::ours;
  }

  std::vector<std::string> names_;
  std::vector<Role> roles_;
  bool is_narrow_;
  double left_ = 0;
  double right_ = 0;
  double end_ = 0;
  double top_ = 0;
};

}  // namespace runstone::bench::chart
