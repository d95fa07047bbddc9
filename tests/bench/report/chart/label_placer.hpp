// The placement of names in a chart, so that they do not overlap.
#pragma once
#include <optional>
#include <vector>

#include "tests/bench/report/chart/svg.hpp"

namespace runstone::bench::chart {

/// Moves positions apart until each is `pitch` from the next one, within [low, high], in their
/// order and as little as possible (least squares). Returns an empty list if they do not fit.
/// Requires finite positions.
std::vector<double> spread(const std::vector<double>& positions, double pitch, double low,
                           double high);

/// The end of the lead from a point to a label: at the label's nearest side.
struct LeadEnd {
  double x = 0;
  double y = 0;
  double length = 0;  // units; a short lead need not be drawn
};
LeadEnd lead_to(const Box& label, double x, double y);

/// Places boxes beside points, in the order of the calls: near the point first, then farther off.
class LabelPlacer {
 public:
  explicit LabelPlacer(const Box& room) : room_(room) {}

  /// Keeps labels off this box.
  void block(const Box& box) { taken_.push_back(box); }

  /// Keeps labels off this point, and labels of other points at some distance.
  void block_point(double x, double y, double radius) { points_.push_back({x, y, radius}); }

  /// Returns room for a label of this size beside the point at (x, y), or nullopt. The room and the
  /// lead from the point to it are then taken. Cost: O(boxes and points).
  std::optional<Box> place(double x, double y, double radius, double width, double height);

 private:
  struct Disc {
    double x, y, radius;
  };

  [[nodiscard]] static std::vector<Box> lead_boxes(const Box& label, double x, double y,
                                                   double radius);
  [[nodiscard]] bool is_free(const Box& box, double x, double y, double margin) const;

  Box room_;
  std::vector<Box> taken_;
  std::vector<Disc> points_;
};

}  // namespace runstone::bench::chart
