#include "tests/reference/outlines.hpp"

#include <array>

namespace runstone::reference {
namespace {

struct Step {
  int u, v;
};
/// Each step is a quarter turn left of the one before: +u, +v, -u, -v.
constexpr std::array<Step, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
/// The faces ahead of a point in the direction of a step, to its left and to its right.
constexpr std::array<Step, 4> kAheadLeft = {{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};
constexpr std::array<Step, 4> kAheadRight = {{{0, -1}, {0, 0}, {-1, 0}, {-1, -1}}};

}  // namespace

void OutlineTracer::trace(const FacePlane& plane, Outlines& out) {
  out.clear();
  const auto width = static_cast<int>(plane.width);
  const auto height = static_cast<int>(plane.height);
  stride_ = plane.width + 2;
  region_.assign(index(width, height) + 1, 0);
  traced_.assign(region_.size(), 0);
  regions_ = 0;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const Material material = plane.row(static_cast<std::uint32_t>(v))[u];
      if (material == kEmpty || region_[index(u, v)] != 0) continue;
      gather(plane, u, v);
      out.regions.push_back({material, static_cast<std::uint32_t>(out.rings.size()), 0, 0});
      // The first face lies lowest, so the first ring is the outer one. Every ring has a side that
      // runs along +u and starts with a corner.
      const auto ours = [this](int at_u, int at_v) {
        return region_[index(at_u, at_v)] == regions_;
      };
      for (const Cell& cell : cells_) {
        const bool side = !ours(cell.u, cell.v - 1);
        const bool corner = !ours(cell.u - 1, cell.v) || ours(cell.u - 1, cell.v - 1);
        if (side && corner && traced_[index(cell.u, cell.v)] == 0) trace_ring(cell.u, cell.v, out);
      }
      out.regions.back().touching /= 2;  // a ring passes the corner once for each of the two faces
    }
  }
}

/// Collects the faces of the region that contains this one.
void OutlineTracer::gather(const FacePlane& plane, int u, int v) {
  ++regions_;
  cells_.clear();
  const Material material = plane.row(static_cast<std::uint32_t>(v))[u];
  const auto take = [&](int at_u, int at_v) {
    if (at_u < 0 || at_v < 0 || at_u >= static_cast<int>(plane.width) ||
        at_v >= static_cast<int>(plane.height)) {
      return;
    }
    std::uint32_t& region = region_[index(at_u, at_v)];
    if (region != 0 || plane.row(static_cast<std::uint32_t>(at_v))[at_u] != material) return;
    region = regions_;
    cells_.push_back({static_cast<std::int16_t>(at_u), static_cast<std::int16_t>(at_v)});
  };
  take(u, v);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Cell cell = cells_[i];
    for (const Step& step : kSteps) take(cell.u + step.u, cell.v + step.v);
  }
}

/// Traces the ring that runs along the lower side of a face, whose start is a corner.
void OutlineTracer::trace_ring(int u, int v, Outlines& out) {
  const std::uint32_t region = region_[index(u, v)];
  const auto first = static_cast<std::uint32_t>(out.points.size());
  const auto corner = [&out](int at_u, int at_v) {
    out.points.push_back({static_cast<std::uint8_t>(at_u), static_cast<std::uint8_t>(at_v)});
  };
  const int start_u = u;
  const int start_v = v;
  std::size_t way = 0;
  corner(u, v);
  for (;;) {
    if (way == 0) traced_[index(u, v)] = 1;
    u += kSteps[way].u;
    v += kSteps[way].v;
    const auto ours = [&](const Step& ahead) {
      return region_[index(u + ahead.u, v + ahead.v)] == region;
    };
    const bool right = ours(kAheadRight[way]);
    std::size_t next = way;
    if (!ours(kAheadLeft[way])) {
      next = (way + 1) % 4;
      if (right) ++out.regions.back().touching;
    } else if (right) {
      next = (way + 3) % 4;
    }
    if (u == start_u && v == start_v && next == 0) break;
    if (next != way) corner(u, v);
    way = next;
  }
  out.rings.push_back({first, static_cast<std::uint32_t>(out.points.size()) - first});
  ++out.regions.back().ring_count;
}

}  // namespace runstone::reference
