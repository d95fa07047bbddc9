#include "common/sculpt/path_brush.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/core/assert.hpp"
#include "common/sculpt/column_writer.hpp"

namespace runstone {
namespace {

/// The voxels between two points of a curve, at most.
constexpr double kCurveStep = 0.5;
/// The room for slopes above and below the curve.
constexpr std::int32_t kPathRoom = 64;

CurvePoint middle_of(VoxelPos place) { return {place.x + 0.5, place.y + 0.5, place.z + 0.5}; }

double distance(const CurvePoint& a, const CurvePoint& b) {
  const double x = b.x - a.x, y = b.y - a.y, z = b.z - a.z;
  return std::sqrt(x * x + y * y + z * z);
}

/// Returns the point at parameter t between a, at `from`, and b, at `to`.
CurvePoint between(const CurvePoint& a, const CurvePoint& b, double from, double to, double t) {
  const double part = to > from ? (t - from) / (to - from) : 0.0;
  return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y), a.z + part * (b.z - a.z)};
}

/// Appends a point, and before it points of the chord, so that none is farther than kCurveStep from
/// the next one.
void add_point(const CurvePoint& point, std::vector<CurvePoint>& out) {
  const CurvePoint from = out.empty() ? point : out.back();
  const auto parts = static_cast<int>(std::ceil(distance(from, point) / kCurveStep));
  for (int i = 1; i < parts; ++i) out.push_back(between(from, point, 0, parts, i));
  out.push_back(point);
}

/// Appends the curve from p[1] to p[2], without p[2].
void add_piece(const std::array<CurvePoint, 4>& p, std::vector<CurvePoint>& out) {
  std::array<double, 4> t{};
  for (std::size_t i = 1; i < 4; ++i) t[i] = t[i - 1] + std::sqrt(distance(p[i - 1], p[i]));
  const auto steps = static_cast<int>(std::ceil(2 * distance(p[1], p[2]))) + 1;
  for (int i = 0; i < steps; ++i) {
    const double at = t[1] + (t[2] - t[1]) * i / steps;
    const CurvePoint a1 = between(p[0], p[1], t[0], t[1], at);
    const CurvePoint a2 = between(p[1], p[2], t[1], t[2], at);
    const CurvePoint a3 = between(p[2], p[3], t[2], t[3], at);
    const CurvePoint b1 = between(a1, a2, t[0], t[2], at);
    const CurvePoint b2 = between(a2, a3, t[1], t[3], at);
    add_point(between(b1, b2, t[1], t[2], at), out);
  }
}

/// Returns the point on the other side of `from`, as far away as `to`.
CurvePoint mirrored(const CurvePoint& from, const CurvePoint& to) {
  return {2 * from.x - to.x, 2 * from.y - to.y, 2 * from.z - to.z};
}

std::int32_t floor_of(double value) { return static_cast<std::int32_t>(std::floor(value)); }

/// Returns the height of the curve at each column of the way, by column, and kNoSurface elsewhere.
std::vector<std::int32_t> heights_of_way(const GroundColumns& columns, const PathBrush& brush,
                                         std::span<const CurvePoint> curve) {
  const VoxelBox& box = columns.box();
  std::vector<std::int32_t> out(columns.count(), kNoSurface);
  std::vector<double> nearest(columns.count(), std::numeric_limits<double>::max());
  const double reach = brush.width / 2.0;
  // The middle of an even number of columns lies between two of them.
  const double shift = brush.width % 2 == 0 ? 0.5 : 0.0;
  for (const CurvePoint& on_curve : curve) {
    const CurvePoint point{on_curve.x + shift, on_curve.y, on_curve.z + shift};
    const std::int32_t low_x = std::max(box.min.x, floor_of(point.x - reach)),
                       high_x = std::min(box.max.x, floor_of(point.x + reach) + 1),
                       low_z = std::max(box.min.z, floor_of(point.z - reach)),
                       high_z = std::min(box.max.z, floor_of(point.z + reach) + 1);
    for (std::int32_t z = low_z; z < high_z; ++z) {
      for (std::int32_t x = low_x; x < high_x; ++x) {
        const double off_x = x + 0.5 - point.x, off_z = z + 0.5 - point.z;
        const double square = off_x * off_x + off_z * off_z;
        const std::size_t i = columns.index(x, z);
        if (square > reach * reach || square >= nearest[i]) continue;
        nearest[i] = square;
        out[i] = floor_of(point.y);
      }
    }
  }
  return out;
}

/// Appends the changes of a column of an even way whose top lies at `way`.
void add_even(const GroundColumns& columns, std::size_t column, std::int32_t surface,
              std::int32_t way, const GroundMaterials& materials, Material material,
              ColumnChanges& out) {
  const VoxelBox& box = columns.box();
  if (way <= box.min.y || std::max(way + kPathHeadroom, surface + 2) >= box.max.y) return;
  ColumnWriter writer(columns, column, out);
  const Standing standing = standing_on(writer, surface, materials);
  const auto is_plant = [&](std::int32_t y) { return standing.is_plant && y == surface + 1; };
  if (surface < way && way - surface <= kPathFillMax) {
    const Material fill = writer.old(surface);
    for (std::int32_t y = surface + 1; y < way; ++y) {
      if (materials.is_open(writer.old(y)) || is_plant(y)) writer.set(y, fill);
    }
  }
  writer.set(way, material);
  const std::int32_t top = way + kPathHeadroom;
  for (std::int32_t y = way + 1; y <= top; ++y) {
    if (materials.is_ground(writer.old(y))) writer.set(y, standing.rest);
    if (is_plant(y)) writer.set(y, kEmpty);
  }
  if (surface == top && standing.is_plant) writer.set(surface + 1, kEmpty);
}

/// Appends the changes of a column whose upper voxel becomes the way.
void add_on_ground(const GroundColumns& columns, std::size_t column, std::int32_t surface,
                   const GroundMaterials& materials, Material material, ColumnChanges& out) {
  if (surface + 2 >= columns.box().max.y) return;
  ColumnWriter writer(columns, column, out);
  const bool has_plant = standing_on(writer, surface, materials).is_plant;
  writer.set(surface, material);
  if (has_plant) writer.set(surface + 1, kEmpty);
}

}  // namespace

std::vector<CurvePoint> curve_through(std::span<const VoxelPos> places) {
  RUNSTONE_ASSERT(!places.empty());
  std::vector<CurvePoint> points;
  for (const VoxelPos& place : places) {
    const CurvePoint next = middle_of(place);
    if (points.empty() || distance(points.back(), next) > 0) points.push_back(next);
  }
  std::vector<CurvePoint> out;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const CurvePoint before = i > 0 ? points[i - 1] : mirrored(points[i], points[i + 1]);
    const CurvePoint after =
        i + 2 < points.size() ? points[i + 2] : mirrored(points[i + 1], points[i]);
    add_piece({before, points[i], points[i + 1], after}, out);
  }
  add_point(points.back(), out);
  return out;
}

VoxelBox path_box(const PathBrush& brush, std::span<const CurvePoint> curve) {
  RUNSTONE_ASSERT(!curve.empty() && brush.width > 0 && brush.width <= kPathWidthMax);
  VoxelBox box;
  const std::int32_t side = brush.width / 2 + 1;
  for (const CurvePoint& point : curve) {
    const VoxelPos at{floor_of(point.x), floor_of(point.y), floor_of(point.z)};
    box = bounding_box(box, {{at.x - side, at.y - kPathRoom, at.z - side},
                             {at.x + side + 1, at.y + kPathRoom + 1, at.z + side + 1}});
  }
  return intersect(
      box, {{-kWorldLimit, -kWorldLimit, -kWorldLimit}, {kWorldLimit, kWorldLimit, kWorldLimit}});
}

ColumnChanges path_changes(const GroundColumns& columns, const GroundMaterials& materials,
                           const PathBrush& brush, std::span<const CurvePoint> curve) {
  const auto surface = surface_heights(columns, materials);
  const auto way = heights_of_way(columns, brush, curve);
  ColumnChanges out;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (way[i] == kNoSurface || surface[i] == kNoSurface) continue;
    if (brush.height == PathHeight::ground) {
      add_on_ground(columns, i, surface[i], materials, brush.material, out);
    } else {
      add_even(columns, i, surface[i], way[i], materials, brush.material, out);
    }
  }
  return out;
}

}  // namespace runstone
