#include "common/builds/rotated_build.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "common/builds/build_builder.hpp"
#include "common/core/assert.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// Sections of the result have so many cells a side.
constexpr std::int32_t kRotatedEdge = 64;
/// Sides that are whole numbers are not rounded up because of the rounding of sines.
constexpr double kSideRounding = 1e-6;

/// The axes of a rotation: the one about which it turns, and the other two, ascending.
struct RotationAxes {
  std::size_t about = 1, u = 0, v = 2;
};

RotationAxes axes_of_rotation(Axis about) {
  if (about == Axis::x) return {0, 1, 2};
  if (about == Axis::z) return {2, 0, 1};
  return {1, 0, 2};
}

/// The order in which the axis runs fastest, then u, then v.
AxisOrder order_about(Axis about) {
  if (about == Axis::x) return AxisOrder::xyz;
  if (about == Axis::z) return AxisOrder::zxy;
  return AxisOrder::yxz;
}

std::array<std::int32_t, 3> array_of(VoxelPos at) { return {at.x, at.y, at.z}; }
VoxelPos voxel_of(const std::array<std::int32_t, 3>& at) { return {at[0], at[1], at[2]}; }

/// The cosine and the sine, which are exact for quarter turns.
struct Turn {
  double cosine = 1, sine = 0;
};

Turn turn_of(const BuildRotation& rotation) {
  const std::int32_t degrees = (rotation.degrees % 360 + 360) % 360;
  constexpr std::array<Turn, 4> kQuarters = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  if (degrees % 90 == 0) return kQuarters[static_cast<std::size_t>(degrees / 90)];
  const double angle = degrees * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle)};
}

/// Returns the first cell of the result whose middle lies at or behind the begin of cell `cell`.
std::int32_t cell_after_scale(std::int32_t cell, std::int32_t percent) {
  // The smallest c with (2 c + 1) * 50 >= cell * percent.
  const std::int64_t twice = (std::int64_t{cell} * percent + 49) / 50;
  return static_cast<std::int32_t>(twice / 2);
}

/// Reads lines of a build along an axis. Each section is brought into the order of the lines once.
class LineReader {
 public:
  LineReader(const Build& build, Axis about)
      : build_(build), axes_(axes_of_rotation(about)), order_(order_about(about)) {}

  /// Calls run(begin, end, number) for the cells [low, high) of a line, which need not lie in the
  /// build: from low to high, without the parts outside.
  template <class F>
  void read(RotatedPlace line, std::int32_t low, std::int32_t high, F&& run) {
    const auto sides = array_of(build_.sides());
    if (line.u < 0 || line.v < 0 || line.u >= sides[axes_.u] || line.v >= sides[axes_.v]) return;
    low = std::max(low, 0);
    high = std::min(high, sides[axes_.about]);
    while (low < high) {
      std::array<std::int32_t, 3> at{};
      at[axes_.about] = low;
      at[axes_.u] = line.u;
      at[axes_.v] = line.v;
      const SectionPos place = build_.section_of(voxel_of(at));
      const VoxelBox box = build_.box_of(place);
      const auto begin = array_of(box.min), end = array_of(box.max);
      const RunChunk& cells = section(build_.section(place));
      const auto side = static_cast<std::uint32_t>(end[axes_.about] - begin[axes_.about]);
      const auto width = static_cast<std::uint32_t>(end[axes_.u] - begin[axes_.u]);
      const std::uint32_t first =
          side * (static_cast<std::uint32_t>(line.u - begin[axes_.u]) +
                  width * static_cast<std::uint32_t>(line.v - begin[axes_.v]));
      const std::int32_t last = std::min(high, end[axes_.about]);
      const auto start = first + static_cast<std::uint32_t>(low - begin[axes_.about]);
      for (std::size_t i = find_run(cells, start); low < last; ++i) {
        const auto run_end =
            static_cast<std::int32_t>(std::min(cells.runs.end(i), first + side) - first) +
            begin[axes_.about];
        const std::int32_t stop = std::min(last, run_end);
        run(low, stop, cells.runs.material(i));
        low = stop;
      }
    }
  }

 private:
  const RunChunk& section(const SectionPtr& section) {
    if (section->order == order_) return *section;
    SectionPtr& ordered = ordered_[section.get()];
    if (!ordered) ordered = std::make_shared<const RunChunk>(reorder(*section, order_));
    return *ordered;
  }

  const Build& build_;
  const RotationAxes axes_;
  const AxisOrder order_;
  std::map<const RunChunk*, SectionPtr> ordered_;
};

}  // namespace

VoxelPos rotated_sides(const BuildRotation& rotation, VoxelPos sides) {
  const RotationAxes axes = axes_of_rotation(rotation.axis);
  const Turn turn = turn_of(rotation);
  const auto old = array_of(sides);
  const auto rounded = [&](double side) {
    return std::max(
        1, static_cast<std::int32_t>(std::ceil(side * rotation.percent / 100 - kSideRounding)));
  };
  const double cosine = std::abs(turn.cosine), sine = std::abs(turn.sine);
  std::array<std::int32_t, 3> out{};
  out[axes.about] = rounded(old[axes.about]);
  out[axes.u] = rounded(old[axes.u] * cosine + old[axes.v] * sine);
  out[axes.v] = rounded(old[axes.u] * sine + old[axes.v] * cosine);
  return voxel_of(out);
}

RotatedPlace place_before_rotation(const BuildRotation& rotation, VoxelPos sides,
                                   RotatedPlace line) {
  const RotationAxes axes = axes_of_rotation(rotation.axis);
  const Turn turn = turn_of(rotation);
  const auto old = array_of(sides), made = array_of(rotated_sides(rotation, sides));
  const double scale = rotation.percent / 100.0;
  // About y, +z turns to +x and +x to -z; so back, u is turned towards v.
  const double u = (line.u + 0.5 - made[axes.u] / 2.0) / scale,
               v = (line.v + 0.5 - made[axes.v] / 2.0) / scale;
  const double back_u = u * turn.cosine - v * turn.sine + old[axes.u] / 2.0,
               back_v = u * turn.sine + v * turn.cosine + old[axes.v] / 2.0;
  return {static_cast<std::int32_t>(std::floor(back_u)),
          static_cast<std::int32_t>(std::floor(back_v))};
}

Result<BuildPtr> rotated_build(const Build& build, const BuildRotation& rotation,
                               std::size_t bytes_max) {
  RUNSTONE_ASSERT(rotation.percent >= kScaleMin && rotation.percent <= kScaleMax);
  const VoxelPos from = build.sides();
  if (std::max({from.x, from.y, from.z}) > kRotatedSideMax * (100 / kScaleMin))
    return fail(ErrorCode::limit_exceeded, "the result is longer than 2,048 voxels");
  const VoxelPos sides = rotated_sides(rotation, from);
  if (std::max({sides.x, sides.y, sides.z}) > kRotatedSideMax)
    return fail(ErrorCode::limit_exceeded, "the result is longer than 2,048 voxels");
  auto out = BuildBuilder::of({grid_cuts(sides.x, kRotatedEdge), grid_cuts(sides.y, kRotatedEdge),
                               grid_cuts(sides.z, kRotatedEdge)},
                              bytes_max);
  if (!out) return failure(out.error());
  std::vector<std::uint16_t> numbers = {0};
  for (const Material material : build.palette()) numbers.push_back(*out->number_of(material));
  const RotationAxes axes = axes_of_rotation(rotation.axis);
  const BuildCuts cuts = out->cuts();
  const std::int32_t percent = rotation.percent;
  LineReader reader(build, rotation.axis);
  for (SectionPos at; at.z + 1U < cuts[2].size(); ++at.z) {
    for (at.y = 0; at.y + 1U < cuts[1].size(); ++at.y) {
      for (at.x = 0; at.x + 1U < cuts[0].size(); ++at.x) {
        const std::array<std::uint32_t, 3> place = {at.x, at.y, at.z};
        std::array<std::int32_t, 3> low{}, side{};
        for (std::size_t i = 0; i < 3; ++i) {
          low[i] = cuts[i][place[i]];
          side[i] = cuts[i][place[i] + 1U] - low[i];
        }
        RunBuilder cells({static_cast<std::uint8_t>(side[0]), static_cast<std::uint8_t>(side[1]),
                          static_cast<std::uint8_t>(side[2])},
                         order_about(rotation.axis));
        const std::int32_t begin = low[axes.about], end = begin + side[axes.about];
        for (std::int32_t v = 0; v < side[axes.v]; ++v) {
          for (std::int32_t u = 0; u < side[axes.u]; ++u) {
            const std::uint32_t line =
                static_cast<std::uint32_t>(side[axes.about] * (u + side[axes.u] * v));
            const RotatedPlace before =
                place_before_rotation(rotation, from, {low[axes.u] + u, low[axes.v] + v});
            reader.read(
                before, cell_before_scale(begin, percent), cell_before_scale(end - 1, percent) + 1,
                [&](std::int32_t first, std::int32_t last, std::uint16_t number) {
                  const std::int32_t to = std::clamp(cell_after_scale(last, percent), begin, end);
                  cells.append_to(
                      line + static_cast<std::uint32_t>(
                                 std::clamp(cell_after_scale(first, percent), begin, end) - begin),
                      0);
                  cells.append_to(line + static_cast<std::uint32_t>(to - begin), numbers[number]);
                });
            cells.append_to(line + static_cast<std::uint32_t>(side[axes.about]), 0);
          }
        }
        if (const auto put = out->put(at, cells.finish()); !put) return failure(put.error());
      }
    }
  }
  return out->finish();
}

}  // namespace runstone
