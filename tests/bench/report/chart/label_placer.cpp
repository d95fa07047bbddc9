#include "tests/bench/report/chart/label_placer.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace runstone::bench::chart {

std::vector<double> spread(const std::vector<double>& positions, double pitch, double low,
                           double high) {
  const std::size_t count = positions.size();
  if (count == 0 || static_cast<double>(count - 1) * pitch > high - low) return {};
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) {
    return positions[a] != positions[b] ? positions[a] < positions[b] : a < b;
  });
  // With the pitch subtracted, the positions must not decrease. Positions that decrease are
  // replaced by their mean (isotonic regression).
  struct Pool {
    double sum;
    std::size_t count;
    [[nodiscard]] double mean() const { return sum / static_cast<double>(count); }
  };
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < count; ++i) {
    pools.push_back({positions[order[i]] - static_cast<double>(i) * pitch, 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean() > pools.back().mean()) {
      const Pool last = pools.back();
      pools.pop_back();
      pools.back().sum += last.sum;
      pools.back().count += last.count;
    }
  }
  const double highest = high - static_cast<double>(count - 1) * pitch;
  std::vector<double> out(count);
  std::size_t i = 0;
  for (const Pool& pool : pools) {
    const double at = std::clamp(pool.mean(), low, highest);
    for (std::size_t k = 0; k < pool.count; ++k, ++i)
      out[order[i]] = at + static_cast<double>(i) * pitch;
  }
  return out;
}

LeadEnd lead_to(const Box& label, double x, double y) {
  const double end_x = std::clamp(x, label.x, label.x + label.width);
  const double end_y = std::clamp(y, label.y + 2, label.y + label.height - 2);
  return {end_x, end_y, std::hypot(end_x - x, end_y - y)};
}

/// Returns small boxes along the lead from a point to its label.
std::vector<Box> LabelPlacer::lead_boxes(const Box& label, double x, double y, double radius) {
  constexpr double kStep = 6;
  const LeadEnd end = lead_to(label, x, y);
  std::vector<Box> out;
  for (double at = radius + kStep; at < end.length - 1; at += kStep) {
    const double share = at / end.length;
    out.push_back({x + (end.x - x) * share - 2, y + (end.y - y) * share - 2, 4, 4});
  }
  return out;
}

bool LabelPlacer::is_free(const Box& box, double x, double y, double margin) const {
  const bool is_inside = box.x >= room_.x && box.y >= room_.y &&
                         box.x + box.width <= room_.x + room_.width &&
                         box.y + box.height <= room_.y + room_.height;
  if (!is_inside) return false;
  const auto is_hit = [&](const Box& other) { return overlap(box, other); };
  if (std::any_of(taken_.begin(), taken_.end(), is_hit)) return false;
  return std::none_of(points_.begin(), points_.end(), [&](const Disc& point) {
    // A label names all points at the same place.
    const double reach = point.radius + (point.x == x && point.y == y ? 0 : margin);
    return is_hit({point.x - reach, point.y - reach, 2 * reach, 2 * reach});
  });
}

std::optional<Box> LabelPlacer::place(double x, double y, double radius, double width,
                                      double height) {
  // A name that is closer to another point would be read as that point's name. Such a place is used
  // only if there is no other.
  for (const double margin : {7.0, 1.0}) {
    for (const double away : {3.0, 9.0, 18.0, 30.0, 44.0, 60.0}) {
      const double gap = radius + away;
      const double slant = gap * 0.7;
      const Box candidates[] = {{x + gap, y - height / 2, width, height},
                                {x - gap - width, y - height / 2, width, height},
                                {x - width / 2, y - gap - height, width, height},
                                {x - width / 2, y + gap, width, height},
                                {x + slant, y - slant - height, width, height},
                                {x + slant, y + slant, width, height},
                                {x - slant - width, y - slant - height, width, height},
                                {x - slant - width, y + slant, width, height}};
      for (const Box& box : candidates) {
        if (!is_free(box, x, y, margin)) continue;
        const std::vector<Box> way = lead_boxes(box, x, y, radius);
        if (!std::all_of(way.begin(), way.end(),
                         [&](const Box& part) { return is_free(part, x, y, 0); }))
          continue;
        block(box);
        taken_.insert(taken_.end(), way.begin(), way.end());
        return box;
      }
    }
  }
  return std::nullopt;
}

}  // namespace runstone::bench::chart
