#include "tests/support/mesh/partition_oracle.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <utility>

namespace runstone::test {

using namespace reference;

unsigned LeastRectangles::of(std::uint64_t region) {
  if (region == 0) return 0;
  if (const auto found = known_.find(region); found != known_.end()) return found->second;
  const auto first = static_cast<unsigned>(std::countr_zero(region));
  unsigned least = ~0u;
  // The first cell is the corner of its rectangle, since no cell of the region lies before it.
  for (unsigned width = 1; first % width_ + width <= width_; ++width) {
    const std::uint64_t row = ((std::uint64_t{1} << width) - 1) << first;
    std::uint64_t rectangle = 0;
    for (unsigned height = 1; first / width_ + height <= height_; ++height) {
      rectangle |= row << (width_ * (height - 1));
      if ((region & rectangle) != rectangle) break;
      least = std::min(least, 1 + of(region & ~rectangle));
    }
  }
  return known_[region] = least;
}

std::size_t matching_size(const BipartiteGraph& graph) {
  std::vector<int> partner(graph.right_count, -1);  // of right vertices
  std::vector<bool> tried;
  const std::function<bool(std::uint32_t)> match = [&](std::uint32_t left) {
    for (std::uint32_t e = graph.first[left]; e < graph.first[left + 1]; ++e) {
      const std::uint32_t right = graph.edges[e];
      if (tried[right]) continue;
      tried[right] = true;
      if (partner[right] >= 0 && !match(static_cast<std::uint32_t>(partner[right]))) continue;
      partner[right] = static_cast<int>(left);
      return true;
    }
    return false;
  };
  std::size_t matched = 0;
  for (std::uint32_t left = 0; left < graph.left_count(); ++left) {
    tried.assign(graph.right_count, false);
    matched += match(left) ? 1u : 0u;
  }
  return matched;
}

namespace {

/// The cells of a plane by component, with a border of 0 around: 0 is no component, numbers start
/// at 1.
class Components {
 public:
  explicit Components(const FacePlane& plane)
      : width(static_cast<int>(plane.width)),
        height(static_cast<int>(plane.height)),
        of_(static_cast<std::size_t>((width + 2) * (height + 2)), 0) {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const auto material = [&plane](int x, int y) {
          return plane.row(static_cast<std::uint32_t>(y))[x];
        };
        if (material(u, v) == kEmpty || at(u, v) != 0) continue;
        ++count;
        flood(u, v, false, [&](int x, int y) {
          if (x < 0 || y < 0 || x >= width || y >= height || at(x, y) != 0) return false;
          if (material(x, y) != material(u, v)) return false;
          of_[slot(x, y)] = count;
          return true;
        });
      }
    }
  }
  int at(int u, int v) const { return of_[slot(u, v)]; }
  /// Returns the number of holes. The cells outside a component are one piece around it and one
  /// more for each hole. Those pieces are also connected across corners.
  int holes(int component) const {
    std::vector<bool> seen(of_.size(), false);
    int pieces = 0;
    for (int v = -1; v <= height; ++v) {
      for (int u = -1; u <= width; ++u) {
        const auto outside = [&](int x, int y) {
          if (x < -1 || y < -1 || x > width || y > height) return false;
          if (seen[slot(x, y)] || at(x, y) == component) return false;
          seen[slot(x, y)] = true;
          return true;
        };
        if (seen[slot(u, v)] || at(u, v) == component) continue;
        ++pieces;
        flood(u, v, true, outside);
      }
    }
    return pieces - 1;
  }

  int width, height;
  int count = 0;

 private:
  std::size_t slot(int u, int v) const {
    return static_cast<std::size_t>((v + 1) * (width + 2) + u + 1);
  }
  /// Continues from each cell that enter(u, v) accepts.
  template <class Enter>
  static void flood(int u, int v, bool across_corners, Enter&& enter) {
    std::vector<std::pair<int, int>> open;
    if (enter(u, v)) open.emplace_back(u, v);
    while (!open.empty()) {
      const auto [x, y] = open.back();
      open.pop_back();
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (dx != 0 && dy != 0 && !across_corners) continue;
          if (enter(x + dx, y + dy)) open.emplace_back(x + dx, y + dy);
        }
      }
    }
  }
  std::vector<int> of_;
};

struct Corner {
  int u, v;  // of the cell below and right
};

/// Returns the corners around which three of the four cells belong to a component.
std::vector<Corner> concave_corners(const Components& cells, int component) {
  std::vector<Corner> corners;
  for (int v = 0; v <= cells.height; ++v) {
    for (int u = 0; u <= cells.width; ++u) {
      const int around = (cells.at(u - 1, v - 1) == component) + (cells.at(u, v - 1) == component) +
                         (cells.at(u - 1, v) == component) + (cells.at(u, v) == component);
      if (around == 3) corners.push_back({u, v});
    }
  }
  return corners;
}

/// Returns true if all cells beside the line from one corner to another belong to a component.
bool runs_inside(const Components& cells, int component, Corner a, Corner b) {
  const bool along_u = a.v == b.v;
  for (int i = along_u ? a.u : a.v; i < (along_u ? b.u : b.v); ++i) {
    const bool inside = along_u
                            ? cells.at(i, a.v - 1) == component && cells.at(i, a.v) == component
                            : cells.at(a.u - 1, i) == component && cells.at(a.u, i) == component;
    if (!inside) return false;
  }
  return true;
}

}  // namespace

std::size_t least_rectangles_by_formula(const FacePlane& plane) {
  const Components cells(plane);
  std::size_t rectangles = 0;
  for (int component = 1; component <= cells.count; ++component) {
    const std::vector<Corner> corners = concave_corners(cells, component);
    std::vector<std::pair<Corner, Corner>> along_u, along_v;
    for (const Corner a : corners) {
      for (const Corner b : corners) {
        if (a.v == b.v && a.u < b.u && runs_inside(cells, component, a, b))
          along_u.emplace_back(a, b);
        if (a.u == b.u && a.v < b.v && runs_inside(cells, component, a, b))
          along_v.emplace_back(a, b);
      }
    }
    BipartiteGraph meetings;
    meetings.right_count = static_cast<std::uint32_t>(along_v.size());
    for (const auto& [left, right] : along_u) {
      for (std::uint32_t i = 0; i < along_v.size(); ++i) {
        const auto& [top, bottom] = along_v[i];
        const bool meet =
            left.u <= top.u && top.u <= right.u && top.v <= left.v && left.v <= bottom.v;
        if (meet) meetings.edges.push_back(i);
      }
      meetings.end_left();
    }
    const std::size_t taken = along_u.size() + along_v.size() - matching_size(meetings);
    rectangles += corners.size() - taken - static_cast<std::size_t>(cells.holes(component)) + 1;
  }
  return rectangles;
}

std::string partition_fault(const FacePlane& plane, const std::vector<PlaneRectangle>& rectangles) {
  std::vector<Material> covered(plane.faces.size(), kEmpty);
  for (const PlaneRectangle& r : rectangles) {
    if (r.width == 0 || r.height == 0) return "a rectangle of nothing";
    if (r.u + r.width > plane.width || r.v + r.height > plane.height)
      return "a rectangle leaves the plane";
    if (r.material == kEmpty) return "a rectangle without a material";
    for (std::uint32_t v = r.v; v < r.v + r.height; ++v) {
      for (std::uint32_t u = r.u; u < r.u + r.width; ++u) {
        Material& cell = covered[static_cast<std::size_t>(v) * plane.width + u];
        if (cell != kEmpty) return "a cell is covered twice";
        cell = r.material;
      }
    }
  }
  return covered == plane.faces ? "" : "a cell is left out, or covered by another material";
}

}  // namespace runstone::test
