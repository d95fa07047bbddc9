#include "common/voxelise/beam.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/core/assert.hpp"
#include "common/runs/run_builder.hpp"
#include "common/voxelise/line_crossings.hpp"
#include "common/voxelise/touched_voxels.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kHalfUnit = kVoxelUnit / 2;
constexpr std::uint32_t kBeamRows = kVoxelSection * kVoxelSection;
static_assert(kVoxeliseSideMax <= 4096 && kBeamRows <= 4096);

/// A stretch of voxels of a row, packed so that it sorts by row and place.
struct RowSpan {
  std::uint32_t row = 0;
  std::int32_t begin = 0, end = 0;
  std::uint64_t packed() const {
    return std::uint64_t{row} << 32 | static_cast<std::uint64_t>(begin) << 16 |
           static_cast<std::uint64_t>(end);
  }
  static RowSpan of(std::uint64_t packed) {
    return {static_cast<std::uint32_t>(packed >> 32),
            static_cast<std::int32_t>(packed >> 16 & 0xffff),
            static_cast<std::int32_t>(packed & 0xffff)};
  }
};

/// A row crosses the mesh before the centre of a voxel, packed so that it sorts by row and place.
struct RowCrossing {
  std::uint32_t row = 0;
  std::int32_t voxel = 0;      // 0 .. the side
  std::int32_t direction = 0;  // 1: the row enters here; -1: it leaves
  std::uint32_t packed() const {
    return row << 14 | static_cast<std::uint32_t>(voxel) << 1 | (direction > 0 ? 1U : 0U);
  }
  static RowCrossing of(std::uint32_t packed) {
    return {packed >> 14, static_cast<std::int32_t>(packed >> 1 & 0x1fff),
            (packed & 1) != 0 ? 1 : -1};
  }
};

/// A voxel that may have the colour of a part. It sorts by row and place. `only_inside`: it counts
/// only if the voxel is inside.
struct ColourCandidate {
  std::uint32_t row = 0;
  std::int32_t voxel = 0;
  bool only_inside = false;
  std::uint32_t part = 0;
  std::uint64_t packed() const {
    static_assert(kModelTrianglesMax < std::size_t{1} << 31);
    return std::uint64_t{row} << 44 | static_cast<std::uint64_t>(voxel) << 32 |
           std::uint64_t{only_inside} << 31 | part;
  }
  static ColourCandidate of(std::uint64_t packed) {
    return {static_cast<std::uint32_t>(packed >> 44),
            static_cast<std::int32_t>(packed >> 32 & 0xfff), (packed >> 31 & 1) != 0,
            static_cast<std::uint32_t>(packed & 0x7fff'ffff)};
  }
};

/// A triangle crosses the line between the centres of two voxels: of `at` and of the voxel before
/// it along `axis`. It sorts by axis and place.
struct WallCrossing {
  unsigned axis = 0;
  std::array<std::int32_t, 3> at{};  // y and z from the beam on; along `axis` up to the side
  std::uint32_t part = 0;
  bool is_positive = false;  // the normal of the triangle points along the axis
  bool is_in_first = false;  // the point is in the voxel before `at`

  std::uint64_t packed() const {
    return place() << 33 | std::uint64_t{part} << 2 | std::uint64_t{is_positive} << 1 |
           std::uint64_t{is_in_first};
  }
  static std::uint64_t place_of(std::uint64_t packed) { return packed >> 33; }
  static WallCrossing of(std::uint64_t packed) {
    const auto bits = [&](unsigned shift, unsigned count) {
      return static_cast<std::int32_t>(packed >> shift & ((1U << count) - 1));
    };
    return {static_cast<unsigned>(bits(60, 2)),
            {bits(47, 13), bits(40, 7), bits(33, 7)},
            static_cast<std::uint32_t>(packed >> 2 & 0x7fff'ffff),
            (packed & 2) != 0,
            (packed & 1) != 0};
  }

 private:
  std::uint64_t place() const {
    return std::uint64_t{axis} << 27 | static_cast<std::uint64_t>(at[0]) << 14 |
           static_cast<std::uint64_t>(at[1]) << 7 | static_cast<std::uint64_t>(at[2]);
  }
};

/// Returns the first voxel whose centre is behind a crossing of a line along an axis, if centre and
/// line are moved by an infinitesimal along x, an infinitely smaller one along y, and again along
/// z.
std::int32_t first_centre_behind(const Crossing& crossing, unsigned axis, const UnitTriangle& t) {
  const std::int32_t first = crossing.first_centre();
  if (axis == 0 || !crossing.is_on_centre()) return first;
  // The point of the line moves against the first other axis along which the triangle is inclined.
  for (unsigned other = 0; other < axis; ++other) {
    const unsigned u = (other + 1) % 3, v = (other + 2) % 3;
    const auto edge = [&](std::size_t to, unsigned along) {
      return std::int64_t{t[to][along]} - t[0][along];
    };
    const std::int64_t normal = edge(1, u) * edge(2, v) - edge(1, v) * edge(2, u);
    if (normal != 0) return (normal > 0) == crossing.is_positive ? first : first + 1;
  }
  return first;
}

/// A voxel of a row with its colour.
struct ShellVoxel {
  std::uint32_t row = 0;
  std::int32_t voxel = 0;
  VoxelRgb colour{};
};

/// When a beam holds so many entries for the first time, it sorts them and drops those that are
/// equal.
constexpr std::size_t kBeamHeldSorted = std::size_t{1} << 22;
/// A beam that holds more than this after it was sorted is refused. It grows to twice as many
/// entries of 8 bytes before it is sorted: 512 MiB.
constexpr std::size_t kBeamHeldMax = std::size_t{1} << 25;

/// Sorts stretches, and joins those that touch or overlap.
void join_spans(std::vector<std::uint64_t>& spans) {
  std::sort(spans.begin(), spans.end());
  std::size_t count = 0;
  for (const std::uint64_t packed : spans) {
    const RowSpan span = RowSpan::of(packed);
    if (count != 0) {
      RowSpan last = RowSpan::of(spans[count - 1]);
      if (last.row == span.row && span.begin <= last.end) {
        last.end = std::max(last.end, span.end);
        spans[count - 1] = last.packed();
        continue;
      }
    }
    spans[count++] = packed;
  }
  spans.resize(count);
}

class BeamMaker {
 public:
  BeamMaker(const BeamPlan& plan, std::int32_t y, std::int32_t z)
      : plan_(plan),
        is_coloured_(!plan.colours->only()),
        side_(plan.placement->side(0)),
        y_(y),
        z_(z),
        voxels_{{0, y, z},
                {side_ - 1, std::min(y + kVoxelSection, plan.placement->side(1)) - 1,
                 std::min(z + kVoxelSection, plan.placement->side(2)) - 1}},
        sections_(static_cast<std::size_t>((side_ + kVoxelSection - 1) / kVoxelSection)),
        rows_y_(static_cast<std::uint32_t>(voxels_.high[1] + 1 - y)) {}

  BeamResult make(std::span<const std::uint32_t> parts) {
    for (const std::uint32_t part : parts) {
      if (plan_.model->is_cloud()) {
        add_ball(part);
      } else {
        add_triangle(part);
      }
      if (!has_room()) {
        result_.holds_too_much = true;
        return std::move(result_);
      }
    }
    if (plan_.is_solid) {
      add_walls();
      find_inside();
    }
    if (is_coloured_) {
      find_shell();
      if (plan_.quantiser == nullptr) {
        count_colours();
        return std::move(result_);
      }
      put_coloured();
    } else {
      if (!spans_.empty()) {
        inside_.insert(inside_.end(), spans_.begin(), spans_.end());
        join_spans(inside_);
      }
      for (const std::uint64_t packed : inside_) put(RowSpan::of(packed), 1);
    }
    finish_sections();
    return std::move(result_);
  }

 private:
  /// Returns false if the beam has found more than it may hold. A file of a few megabytes can have
  /// 100,000 triangles that all cover the beam.
  bool has_room() {
    if (held() <= held_max_) return true;
    std::sort(candidates_.begin(), candidates_.end());
    candidates_.erase(std::unique(candidates_.begin(), candidates_.end()), candidates_.end());
    join_spans(spans_);
    // Sorting pays only if it is rare.
    held_max_ = std::max(kBeamHeldSorted, 2 * held());
    return held() <= kBeamHeldMax;
  }
  std::size_t held() const {
    return crossings_.size() + candidates_.size() + spans_.size() + walls_.size();
  }

  bool holds(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return x >= 0 && x <= voxels_.high[0] && y >= y_ && y <= voxels_.high[1] && z >= z_ &&
           z <= voxels_.high[2];
  }
  std::uint32_t row_of(std::int32_t y, std::int32_t z) const {
    return static_cast<std::uint32_t>((z - z_) * kVoxelSection + (y - y_));
  }
  std::int32_t y_of(std::uint32_t row) const {
    return y_ + static_cast<std::int32_t>(row % kVoxelSection);
  }
  std::int32_t z_of(std::uint32_t row) const {
    return z_ + static_cast<std::int32_t>(row / kVoxelSection);
  }

  /// Adds a voxel that a part may colour, if it is in the beam.
  void add_candidate(const std::array<std::int32_t, 3>& at, std::uint32_t part, bool only_inside) {
    if (!holds(at[0], at[1], at[2])) return;
    candidates_.push_back(ColourCandidate{row_of(at[1], at[2]), at[0], only_inside, part}.packed());
  }
  /// Adds voxels of the surface: first .. last of a row of the beam.
  void add_surface(std::int32_t y, std::int32_t z, std::int32_t first, std::int32_t last,
                   std::uint32_t part) {
    if (is_coloured_) {
      for (std::int32_t x = first; x <= last; ++x) add_candidate({x, y, z}, part, false);
    } else {
      spans_.push_back(RowSpan{row_of(y, z), first, last + 1}.packed());
    }
  }
  void add_surface_voxel(const std::array<std::int32_t, 3>& at, std::uint32_t part) {
    if (holds(at[0], at[1], at[2])) add_surface(at[1], at[2], at[0], at[0], part);
  }

  void add_triangle(std::uint32_t part) {
    const UnitTriangle t = plan_.placement->triangle(*plan_.model, part);
    if (plan_.is_solid) {
      for_each_crossing<true>(
          t, 0, kHalfUnit, voxels_, [&](const auto& line, const Crossing& crossing) {
            const RowCrossing at{row_of(line[1], line[2]), std::min(crossing.first_centre(), side_),
                                 crossing.is_positive ? -1 : 1};
            crossings_.push_back(at.packed());
          });
      if (is_coloured_) add_shell(t, part);
    }
    switch (plan_.surface) {
      case SurfaceMode::none:
        break;
      case SurfaceMode::conservative:
        for_each_touched(
            t, voxels_, [&](std::int32_t y, std::int32_t z, std::int32_t first, std::int32_t last) {
              add_surface(y, z, first, last, part);
            });
        break;
      case SurfaceMode::separating_26:
        add_thick(t, part);
        break;
      case SurfaceMode::separating_6:
        if (is_closed_solid()) {
          add_wall_crossings(t, part);
        } else {
          add_thin(t, part);
        }
        break;
    }
  }

  /// Adds the voxels on either side of where the triangle crosses a line between two centres.
  void add_shell(const UnitTriangle& t, std::uint32_t part) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      for_each_crossing<true>(t, axis, kHalfUnit, voxels_,
                              [&](std::array<std::int32_t, 3> at, const Crossing& crossing) {
                                const std::int32_t behind = crossing.first_centre();
                                const std::int32_t last =
                                    crossing.is_on_centre() ? behind + 1 : behind;
                                for (at[axis] = behind - 1; at[axis] <= last; ++at[axis])
                                  add_candidate(at, part, true);
                              });
    }
  }

  void add_thin(const UnitTriangle& t, std::uint32_t part) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const std::int32_t last = plan_.placement->side(axis) - 1;
      for_each_crossing<false>(t, axis, kHalfUnit, voxels_,
                               [&](std::array<std::int32_t, 3> at, const Crossing& crossing) {
                                 at[axis] = std::min(crossing.voxel(), last);
                                 add_surface_voxel(at, part);
                               });
    }
  }

  /// Returns true if the crossings between two centres say whether one of them is inside.
  bool is_closed_solid() const {
    return plan_.is_solid && (plan_.winding == nullptr || plan_.winding->is_zero());
  }

  void add_wall_crossings(const UnitTriangle& t, std::uint32_t part) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const std::int32_t side = plan_.placement->side(axis);
      const std::int32_t low = axis == 0 ? 0 : voxels_.low[axis];
      const std::int32_t high = voxels_.high[axis] + 1;
      for_each_crossing<true>(
          t, axis, kHalfUnit, voxels_,
          [&](std::array<std::int32_t, 3> at, const Crossing& crossing) {
            at[axis] = std::min(first_centre_behind(crossing, axis, t), side);
            if (at[axis] < low || at[axis] > high) return;
            const std::int32_t voxel = std::min(crossing.voxel(), side - 1);
            const bool is_in_first = voxel < at[axis];
            at[1] -= y_;
            at[2] -= z_;
            walls_.push_back(
                WallCrossing{axis, at, part, crossing.is_positive, is_in_first}.packed());
          });
    }
  }

  /// Adds the thin surface where it is not the border of the solid. Of two neighbours, one is
  /// inside and the other is not if the line between their centres crosses the mesh an odd number
  /// of times; by winding number at least one is inside if the signed crossings do not cancel out.
  void add_walls() {
    std::sort(walls_.begin(), walls_.end());
    for (std::size_t begin = 0; begin < walls_.size();) {
      std::size_t end = begin;
      std::int64_t sum = 0;
      for (; end < walls_.size() &&
             WallCrossing::place_of(walls_[end]) == WallCrossing::place_of(walls_[begin]);
           ++end)
        sum += WallCrossing::of(walls_[end]).is_positive ? 1 : -1;
      const bool is_border = plan_.winding != nullptr ? sum != 0 : (end - begin) % 2 != 0;
      for (; begin < end; ++begin) {
        if (is_border) continue;
        WallCrossing wall = WallCrossing::of(walls_[begin]);
        if (wall.is_in_first) --wall.at[wall.axis];
        wall.at[1] += y_;
        wall.at[2] += z_;
        add_surface_voxel(wall.at, wall.part);
      }
    }
    walls_ = {};
  }

  void add_thick(const UnitTriangle& t, std::uint32_t part) {
    // The edges of the voxels of the beam, those on the far sides included.
    LineRanges lines = voxels_;
    for (std::int32_t& high : lines.high) ++high;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const unsigned u = (axis + 1) % 3, v = (axis + 2) % 3;
      for_each_crossing<false>(
          t, axis, 0, lines,
          [&](const std::array<std::int32_t, 3>& line, const Crossing& crossing) {
            const std::int32_t voxel = crossing.voxel();
            std::array<std::int32_t, 3> at{};
            for (at[axis] = crossing.is_on_plane() ? voxel - 1 : voxel; at[axis] <= voxel;
                 ++at[axis]) {
              for (at[u] = line[u] - 1; at[u] <= line[u]; ++at[u]) {
                for (at[v] = line[v] - 1; at[v] <= line[v]; ++at[v]) add_surface_voxel(at, part);
              }
            }
          });
    }
  }

  void add_ball(std::uint32_t part) {
    const UnitPoint p = plan_.placement->at(plan_.model->positions[part]);
    const std::array<std::int32_t, 3> own{
        std::min(p[0] / kVoxelUnit, side_ - 1),
        std::min(p[1] / kVoxelUnit, plan_.placement->side(1) - 1),
        std::min(p[2] / kVoxelUnit, plan_.placement->side(2) - 1)};
    add_surface_voxel(own, part);
    std::array<WholeRange, 3> box;
    for (unsigned axis = 0; axis < 3; ++axis) {
      box[axis].low = std::max<std::int64_t>(
          quotient_up(p[axis] - plan_.radius - kHalfUnit, kVoxelUnit), voxels_.low[axis]);
      box[axis].high = std::min<std::int64_t>(
          quotient_down(p[axis] + plan_.radius - kHalfUnit, kVoxelUnit), voxels_.high[axis]);
    }
    const auto from_centre = [&](unsigned axis, std::int64_t voxel) {
      return voxel * kVoxelUnit + kHalfUnit - p[axis];
    };
    for (std::int64_t z = box[2].low; z <= box[2].high; ++z) {
      for (std::int64_t y = box[1].low; y <= box[1].high; ++y) {
        const std::int64_t dy = from_centre(1, y), dz = from_centre(2, z);
        const std::int64_t rest = plan_.radius * plan_.radius - dy * dy - dz * dz;
        if (rest < 0) continue;
        // Squares are below 2^30, so the root is at most 1 too large or too small.
        auto reach = static_cast<std::int64_t>(std::sqrt(static_cast<double>(rest)));
        while (reach * reach > rest) --reach;
        while ((reach + 1) * (reach + 1) <= rest) ++reach;
        const auto first = std::max(quotient_up(p[0] - reach - kHalfUnit, kVoxelUnit), box[0].low);
        const auto last =
            std::min(quotient_down(p[0] + reach - kHalfUnit, kVoxelUnit), box[0].high);
        if (first <= last)
          add_surface(static_cast<std::int32_t>(y), static_cast<std::int32_t>(z),
                      static_cast<std::int32_t>(first), static_cast<std::int32_t>(last), part);
      }
    }
  }

  /// Sorts the crossings: into rows first, each of which has few.
  void sort_crossings() {
    std::vector<std::uint32_t> ends(kBeamRows + 1);
    for (const std::uint32_t packed : crossings_) ++ends[RowCrossing::of(packed).row + 1];
    for (std::size_t row = 0; row < kBeamRows; ++row) ends[row + 1] += ends[row];
    std::vector<std::uint32_t> sorted(crossings_.size());
    for (const std::uint32_t packed : crossings_)
      sorted[ends[RowCrossing::of(packed).row]++] = packed;
    // ends[row] is the end of the row now.
    std::uint32_t begin = 0;
    for (std::size_t row = 0; row < kBeamRows; begin = ends[row++])
      std::sort(sorted.begin() + begin, sorted.begin() + ends[row]);
    crossings_ = std::move(sorted);
  }

  /// Finds the stretches of voxels that are inside, from the crossings.
  void find_inside() {
    sort_crossings();
    if (plan_.winding != nullptr && !plan_.winding->is_zero()) {
      find_inside_open();
      return;
    }
    std::uint32_t row = kBeamRows;
    std::int32_t count = 0, begin = 0;
    for (const std::uint32_t packed : crossings_) {
      const RowCrossing at = RowCrossing::of(packed);
      if (at.row != row) {
        row = at.row;
        count = 0;
      }
      const bool was_inside = count != 0;
      count = plan_.winding != nullptr ? count + at.direction : 1 - count;
      if (was_inside == (count != 0)) continue;
      if (!was_inside) {
        begin = at.voxel;
      } else if (begin < at.voxel) {
        add_inside({row, begin, at.voxel});
      }
    }
  }

  /// Adds a stretch behind all that were added. Joins it to the last one if they touch.
  void add_inside(const RowSpan& span) {
    if (!inside_.empty()) {
      RowSpan last = RowSpan::of(inside_.back());
      if (last.row == span.row && last.end == span.begin) {
        last.end = span.end;
        inside_.back() = last.packed();
        return;
      }
    }
    inside_.push_back(span.packed());
  }

  void find_inside_open() {
    std::vector<std::uint32_t> begins(kBeamRows + 1);
    std::vector<std::int32_t> counts;  // [i]: signed crossings of the row up to crossing i
    counts.reserve(crossings_.size());
    for (const std::uint32_t packed : crossings_) {
      const RowCrossing at = RowCrossing::of(packed);
      const bool is_first = begins[at.row + 1]++ == 0;
      counts.push_back((is_first ? 0 : counts.back()) + at.direction);
    }
    for (std::size_t row = 0; row < kBeamRows; ++row) begins[row + 1] += begins[row];
    const VoxelBlock whole{{0, y_, z_}, {side_, voxels_.high[1] + 1, voxels_.high[2] + 1}};
    const auto take = [&](const VoxelBlock& block, double offset) {
      for (std::int32_t z = block.low[2]; z < block.high[2]; ++z) {
        for (std::int32_t y = block.low[1]; y < block.high[1]; ++y) {
          const std::uint32_t row = row_of(y, z);
          const std::size_t end = begins[row + 1];
          const std::uint32_t from = RowCrossing{row, block.low[0], 1}.packed();
          auto next = static_cast<std::size_t>(
              std::upper_bound(crossings_.begin() + begins[row],
                               crossings_.begin() + static_cast<std::ptrdiff_t>(end), from) -
              crossings_.begin());
          std::int32_t count = next == begins[row] ? 0 : counts[next - 1];
          for (std::int32_t x = block.low[0]; x < block.high[0];) {
            std::int32_t to = block.high[0];
            if (next < end) to = std::min(to, RowCrossing::of(crossings_[next]).voxel);
            if (x < to && std::abs(count + offset) > 0.5)
              spans_inside_.push_back(RowSpan{row, x, to}.packed());
            x = std::max(x, to);
            if (next < end && x < block.high[0]) count = counts[next++];
          }
        }
      }
    };
    if (!plan_.winding->decide(whole, take)) result_.is_too_much = true;
    join_spans(spans_inside_);
    inside_ = std::move(spans_inside_);
  }

  /// Finds the colours of the voxels that are on a surface.
  void find_shell() {
    std::sort(candidates_.begin(), candidates_.end());
    candidates_.erase(std::unique(candidates_.begin(), candidates_.end()), candidates_.end());
    std::size_t span = 0;
    for (std::size_t begin = 0; begin < candidates_.size();) {
      const std::uint64_t cell = candidates_[begin] >> 32;
      std::size_t end = begin;
      while (end < candidates_.size() && candidates_[end] >> 32 == cell) ++end;
      const ColourCandidate first = ColourCandidate::of(candidates_[begin]);
      const std::uint64_t last_voxel = RowSpan{first.row, first.voxel, first.voxel}.packed();
      // Stretches that end at this voxel or before it.
      while (span < inside_.size()) {
        const RowSpan at = RowSpan::of(inside_[span]);
        if (RowSpan{at.row, at.end, at.end}.packed() > last_voxel) break;
        ++span;
      }
      bool is_inside = false;
      if (span < inside_.size()) {
        const RowSpan at = RowSpan::of(inside_[span]);
        is_inside = at.row == first.row && at.begin <= first.voxel;
      }
      if (const auto colour = colour_of(begin, end, is_inside))
        shell_.push_back({first.row, first.voxel, *colour});
      begin = end;
    }
    candidates_.clear();
  }

  /// Returns the colour of the nearest part, or nullopt if the voxel is not on a surface.
  std::optional<VoxelRgb> colour_of(std::size_t begin, std::size_t end, bool is_inside) {
    nearest_.clear();
    const ColourCandidate first = ColourCandidate::of(candidates_[begin]);
    const VoxelPos voxel{first.voxel, y_of(first.row), z_of(first.row)};
    for (std::size_t i = begin; i < end; ++i) {
      const ColourCandidate candidate = ColourCandidate::of(candidates_[i]);
      if (candidate.only_inside && !is_inside) continue;
      nearest_.push_back({0, candidate.part, {}});
    }
    if (plan_.model->is_cloud()) return nearest_point(voxel);
    if (nearest_.size() == 1 && plan_.colours->is_plain(nearest_[0].part))
      return plan_.colours->at(nearest_[0].part, {});
    for (Near& near : nearest_) {
      near.place = plan_.colours->nearest(near.part, voxel);
      near.distance2 = near.place.distance2;
    }
    std::sort(nearest_.begin(), nearest_.end(), [](const Near& a, const Near& b) {
      return std::pair(a.distance2, a.part) < std::pair(b.distance2, b.part);
    });
    for (const Near& near : nearest_) {
      if (const auto colour = plan_.colours->at(near.part, near.place)) return colour;
    }
    return std::nullopt;
  }

  std::optional<VoxelRgb> nearest_point(VoxelPos voxel) {
    const std::array<std::int32_t, 3> at{voxel.x, voxel.y, voxel.z};
    for (Near& near : nearest_) {
      const UnitPoint p = plan_.placement->at(plan_.model->positions[near.part]);
      for (std::size_t i = 0; i < 3; ++i) {
        const double d = at[i] * kVoxelUnit + kHalfUnit - p[i];
        near.distance2 += d * d;
      }
    }
    const auto best =
        std::min_element(nearest_.begin(), nearest_.end(), [](const Near& a, const Near& b) {
          return std::pair(a.distance2, a.part) < std::pair(b.distance2, b.part);
        });
    return plan_.colours->of_point(best->part);
  }

  void count_colours() {
    std::vector<VoxelRgb> all;
    all.reserve(shell_.size());
    for (const ShellVoxel& voxel : shell_) all.push_back(voxel.colour);
    std::sort(all.begin(), all.end());
    for (const VoxelRgb& colour : all) {
      if (result_.colours.empty() || result_.colours.back().first != colour)
        result_.colours.emplace_back(colour, 0);
      ++result_.colours.back().second;
    }
  }

  Material material_of(const VoxelRgb& colour) {
    if (!last_colour_ || *last_colour_ != colour) {
      last_colour_ = colour;
      last_material_ = static_cast<Material>(plan_.quantiser->index_of(colour) + 1);
    }
    return last_material_;
  }

  void put_coloured() {
    std::size_t shell = 0;
    const auto shell_is_before = [&](std::uint32_t row, std::int32_t x) {
      return shell < shell_.size() &&
             std::pair(shell_[shell].row, shell_[shell].voxel) < std::pair(row, x);
    };
    const auto put_shell = [&] {
      const ShellVoxel& at = shell_[shell++];
      put({at.row, at.voxel, at.voxel + 1}, material_of(at.colour));
    };
    Material inner = 1;
    for (const std::uint64_t packed : inside_) {
      const RowSpan span = RowSpan::of(packed);
      while (shell_is_before(span.row, span.begin)) put_shell();
      std::int32_t x = span.begin;
      if (shell_is_before(span.row, span.end)) inner = material_of(shell_[shell].colour);
      while (shell_is_before(span.row, span.end)) {
        const ShellVoxel& at = shell_[shell++];
        put({span.row, x, at.voxel}, inner);
        inner = material_of(at.colour);
        x = at.voxel;
      }
      put({span.row, x, span.end}, inner);
    }
    while (shell < shell_.size()) put_shell();
  }

  Extent extent_of(std::size_t section) const {
    const std::int32_t x = static_cast<std::int32_t>(section) * kVoxelSection;
    return {static_cast<std::uint8_t>(std::min(kVoxelSection, side_ - x)),
            static_cast<std::uint8_t>(voxels_.high[1] + 1 - y_),
            static_cast<std::uint8_t>(voxels_.high[2] + 1 - z_)};
  }

  /// Appends voxels to the sections. Requires stretches in the order of rows and places.
  void put(const RowSpan& span, Material material) {
    result_.voxels += static_cast<std::uint64_t>(span.end - span.begin);
    const std::uint32_t line = span.row / kVoxelSection * rows_y_ + span.row % kVoxelSection;
    std::int32_t x = span.begin;
    for (std::int32_t low = x / kVoxelSection * kVoxelSection; x < span.end; low += kVoxelSection) {
      const auto section = static_cast<std::size_t>(low / kVoxelSection);
      const std::int32_t end = std::min(span.end, low + kVoxelSection);
      const auto width = static_cast<std::uint32_t>(std::min(kVoxelSection, side_ - low));
      if (!sections_[section]) sections_[section].emplace(extent_of(section), AxisOrder::xyz);
      RunBuilder& runs = *sections_[section];
      runs.append_to(line * width + static_cast<std::uint32_t>(x - low), kEmpty);
      runs.append_to(line * width + static_cast<std::uint32_t>(end - low), material);
      x = end;
    }
  }

  void finish_sections() {
    for (std::size_t section = 0; section < sections_.size(); ++section) {
      if (!sections_[section]) continue;
      RunBuilder& runs = *sections_[section];
      runs.append_to(extent_of(section).volume(), kEmpty);
      result_.pieces.push_back(
          {{static_cast<std::int32_t>(section) * kVoxelSection, y_, z_}, runs.finish()});
    }
  }

  struct Near {
    double distance2 = 0;
    std::uint32_t part = 0;
    ModelColours::Nearest place;
  };

  const BeamPlan& plan_;
  bool is_coloured_;
  std::int32_t side_;
  std::int32_t y_, z_;
  LineRanges voxels_;  // of the beam
  std::vector<std::uint32_t> crossings_;
  std::size_t held_max_ = kBeamHeldSorted;
  std::vector<std::uint64_t> walls_;         // of a thin surface that is beside a solid
  std::vector<std::uint64_t> spans_;         // of the surface, if there is one colour
  std::vector<std::uint64_t> spans_inside_;  // not in order
  std::vector<std::uint64_t> inside_;        // in order, disjoint
  std::vector<std::uint64_t> candidates_;
  std::vector<ShellVoxel> shell_;  // in order
  std::vector<Near> nearest_;
  std::optional<VoxelRgb> last_colour_;
  Material last_material_ = 1;
  std::vector<std::optional<RunBuilder>> sections_;
  std::uint32_t rows_y_;  // of a layer
  BeamResult result_;
};

}  // namespace

BeamResult make_beam(const BeamPlan& plan, std::int32_t y, std::int32_t z,
                     std::span<const std::uint32_t> parts) {
  return BeamMaker(plan, y, z).make(parts);
}

}  // namespace runstone
