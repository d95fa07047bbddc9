// Where names go so that they do not overlap.
#pragma once
#include <optional>
#include <vector>

#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

/// Moves positions apart until each is `pitch` from the next one, within [low, high], in their order and moved as
/// little as can be (least squares). Empty if they do not fit at all. Requires finite positions.
std::vector<double> spread(const std::vector<double>& positions, double pitch, double low,
                           double high);

/// Where the lead from a point to a label ends: at the label's nearest side.
struct LeadEnd {
  double x = 0;
  double y = 0;
  double length = 0;  // units; a short lead need not be drawn
};
LeadEnd lead_to(const Box& label, double x, double y);

/// Places boxes beside points, first come, first served: near by first, then farther off.
class LabelPlacer {
 public:
  explicit LabelPlacer(const Box& room) : room_(room) {}

  /// Nothing shall cover this.
  void block(const Box& box) { taken_.push_back(box); }

  /// Likewise, and labels of other points keep some distance.
  void block_point(double x, double y, double radius) { points_.push_back({x, y, radius}); }

  /// Room for a label of this size beside the point at (x, y), which is then taken, and so is the way of the lead
  /// from point to label. O(boxes and points).
  std::optional<Box> place(double x, double y, double radius, double width, double height);

 private:
  struct Disc {
    double x, y, radius;
  };

  [[nodiscard]] static std::vector<Box> way_of(const Box& label, double x, double y, double radius);
  [[nodiscard]] bool is_free(const Box& box, double x, double y, double margin) const;

  Box room_;
  std::vector<Box> taken_;
  std::vector<Disc> points_;
};

}  // namespace runstone::bench::chart
