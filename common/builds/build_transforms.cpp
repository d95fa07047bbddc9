#include "common/builds/build_transforms.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "common/builds/build_builder.hpp"
#include "common/builds/widened.hpp"
#include "common/core/assert.hpp"
#include "common/core/build_info.hpp"
#include "common/runs/cut.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// The edge of the sections of a stack whose copies cannot share theirs.
constexpr std::int32_t kStackEdge = 64;

constexpr std::array<Axis, 3> kTurnAxes = {Axis::x, Axis::y, Axis::z};

std::size_t index_of_axis(Axis axis) { return static_cast<std::size_t>(axis); }

std::array<std::uint32_t, 3> by_axis(SectionPos at) { return {at.x, at.y, at.z}; }
std::array<std::int32_t, 3> by_axis(VoxelPos at) { return {at.x, at.y, at.z}; }

/// Turns sections. Equal objects stay equal objects.
class SectionTurn {
 public:
  explicit SectionTurn(const Orientation& orientation) : orientation_(orientation) {
    for (const Axis axis : kTurnAxes) {
      const Axis old = orientation.along(axis);
      world_axis_[index_of_axis(old)] = axis;
      if (orientation.flipped(axis))
        mirrored_ = static_cast<std::uint8_t>(mirrored_ | 1U << index_of_axis(old));
    }
  }

  RunChunk operator()(const RunChunk& cells) const {
    RunChunk out = mirrored_ == 0 || cells.is_uniform()
                       ? cells
                       : cut(cells, {0, 0, 0}, cells.extent, mirrored_);
    const auto axes = axes_of(cells.order);
    const std::array<Axis, 3> names = {world_axis_[index_of_axis(axes[0])],
                                       world_axis_[index_of_axis(axes[1])],
                                       world_axis_[index_of_axis(axes[2])]};
    out.order = *std::find_if(kAxisOrders.begin(), kAxisOrders.end(),
                              [&](AxisOrder order) { return axes_of(order) == names; });
    out.extent = orientation_.rotated(cells.extent);
    return out;
  }

 private:
  Orientation orientation_;
  std::array<Axis, 3> world_axis_{};  // by axis of the build
  std::uint8_t mirrored_ = 0;         // by axis of the build
};

/// Calls f(place) for each section, in the order of the grid.
template <class F>
Result<void> for_each_section(SectionPos counts, F&& f) {
  for (SectionPos at; at.z < counts.z; ++at.z) {
    for (at.y = 0; at.y < counts.y; ++at.y) {
      for (at.x = 0; at.x < counts.x; ++at.x) {
        if (const auto done = f(at); !done) return done;
      }
    }
  }
  return {};
}

SectionPos counts_of(const BuildCuts& cuts) {
  const auto count = [&](std::size_t i) { return static_cast<std::uint32_t>(cuts[i].size() - 1); };
  return {count(0), count(1), count(2)};
}

/// Gives the palette of a build to a builder, in its order, so that cell numbers stay.
void take_palette(const Build& build, BuildBuilder& out) {
  for (const Material material : build.palette()) static_cast<void>(out.number_of(material));
}

Result<void> check_length(VoxelPos offset, std::int32_t times, VoxelPos sides) {
  const auto o = by_axis(offset), s = by_axis(sides);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t way = std::abs(std::int64_t{o[i]}) * times;
    if (way + s[i] > kBuildSideMax)
      return fail(ErrorCode::limit_exceeded, "build is longer than 1,048,576 voxels");
  }
  return {};
}

/// The copies of a stack that lie beside each other along one axis.
struct Row {
  std::size_t axis = 0;
  std::int32_t step = 0;  // from copy to copy, at least the side; the smaller coordinate first
};

std::optional<Row> row_of(VoxelPos offset, VoxelPos sides) {
  const auto o = by_axis(offset), s = by_axis(sides);
  std::optional<Row> out;
  for (std::size_t i = 0; i < 3; ++i) {
    if (o[i] == 0) continue;
    if (out || std::abs(o[i]) < s[i]) return std::nullopt;
    out = Row{i, std::abs(o[i])};
  }
  return out;
}

Result<BuildPtr> stacked_row(const Build& build, const Row& row, std::int32_t copies,
                             std::size_t bytes_max) {
  BuildCuts cuts = build.cuts();
  auto& along = cuts[row.axis];
  const std::vector<std::int32_t> one = along;
  const std::vector<std::int32_t> gap = one.back() == row.step
                                            ? std::vector<std::int32_t>{0}
                                            : grid_cuts(row.step - one.back(), kStackEdge);
  // The builder checks the memory of the grid. A row of more cuts than that is not begun.
  const std::uint64_t cuts_of_copy = one.size() + gap.size() - 2;
  if (cuts_of_copy * static_cast<std::uint64_t>(copies) > bytes_max / sizeof(std::int32_t))
    return fail(ErrorCode::limit_exceeded, "build takes too much memory");
  for (std::int32_t i = 1; i < copies; ++i) {
    const std::int32_t end = along.back();
    for (std::size_t k = 1; k < gap.size(); ++k) along.push_back(end + gap[k]);
    const std::int32_t begin = along.back();
    for (std::size_t k = 1; k < one.size(); ++k) along.push_back(begin + one[k]);
  }
  auto out = BuildBuilder::of(std::move(cuts), bytes_max);
  if (!out) return failure(out.error());
  take_palette(build, *out);
  const auto whole = static_cast<std::uint32_t>(one.size() - 1);
  const auto step = static_cast<std::uint32_t>(cuts_of_copy);
  const auto done = for_each_section(counts_of(out->cuts()), [&](SectionPos at) -> Result<void> {
    auto place = by_axis(at);
    place[row.axis] %= step;
    if (place[row.axis] >= whole) return {};  // between two copies
    return out->put(at, build.section({place[0], place[1], place[2]}));
  });
  if (!done) return failure(done.error());
  return out->finish();
}

VoxelBox moved_by(const VoxelBox& box, const std::array<std::int64_t, 3>& by) {
  const auto add = [&](VoxelPos at) {
    return VoxelPos{static_cast<std::int32_t>(at.x + by[0]),
                    static_cast<std::int32_t>(at.y + by[1]),
                    static_cast<std::int32_t>(at.z + by[2])};
  };
  return {add(box.min), add(box.max)};
}

Result<BuildPtr> stacked_anywhere(const Build& build, VoxelPos offset, std::int32_t copies,
                                  std::size_t bytes_max) {
  const auto o = by_axis(offset), s = by_axis(build.sides());
  const auto corner = by_axis(stack_corner(offset, copies - 1));
  BuildCuts cuts;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t side = std::abs(std::int64_t{o[i]}) * (copies - 1) + s[i];
    if (side / kStackEdge > static_cast<std::int64_t>(bytes_max / sizeof(std::int32_t)))
      return fail(ErrorCode::limit_exceeded, "build takes too much memory");
    cuts[i] = grid_cuts(static_cast<std::int32_t>(side), kStackEdge);
  }
  auto out = BuildBuilder::of(std::move(cuts), bytes_max);
  if (!out) return failure(out.error());
  take_palette(build, *out);
  const BuildCuts planes = out->cuts();
  const auto done = for_each_section(counts_of(planes), [&](SectionPos at) -> Result<void> {
    const auto place = by_axis(at);
    std::array<std::int64_t, 3> low{}, high{};
    std::int64_t first = 0, last = copies - 1;
    // The copies whose box meets the section: along each axis they are consecutive.
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::int64_t{planes[i][place[i]]} + corner[i];
      high[i] = std::int64_t{planes[i][place[i] + 1U]} + corner[i];
      while (first <= last && !(first * o[i] < high[i] && first * o[i] + s[i] > low[i])) ++first;
      while (first <= last && !(last * o[i] < high[i] && last * o[i] + s[i] > low[i])) --last;
    }
    if (first > last) return {};
    const VoxelBox box{{static_cast<std::int32_t>(low[0]), static_cast<std::int32_t>(low[1]),
                        static_cast<std::int32_t>(low[2])},
                       {static_cast<std::int32_t>(high[0]), static_cast<std::int32_t>(high[1]),
                        static_cast<std::int32_t>(high[2])}};
    std::optional<RunChunk> cells;
    for (std::int64_t i = first; i <= last; ++i) {
      const std::array<std::int64_t, 3> way = {i * o[0], i * o[1], i * o[2]};
      const std::array<std::int64_t, 3> back = {-way[0], -way[1], -way[2]};
      const VoxelBox part = intersect(box, moved_by(build.box(), way));
      if (part.empty()) continue;
      RunChunk copy = widened(cells_in(build, moved_by(part, back)), part, box);
      cells = cells ? overlaid(*cells, copy) : std::move(copy);
    }
    if (!cells) return {};
    return out->put(at, *std::move(cells));
  });
  if (!done) return failure(done.error());
  return out->finish();
}

}  // namespace

Result<BuildPtr> turned(const Build& build, const Orientation& orientation, std::size_t bytes_max) {
  BuildCuts cuts;
  for (const Axis axis : kTurnAxes) {
    auto& along = cuts[index_of_axis(axis)];
    along = build.cuts()[index_of_axis(orientation.along(axis))];
    if (!orientation.flipped(axis)) continue;
    const std::int32_t side = along.back();
    std::reverse(along.begin(), along.end());
    for (std::int32_t& cut_at : along) cut_at = side - cut_at;
  }
  auto out = BuildBuilder::of(std::move(cuts), bytes_max);
  if (!out) return failure(out.error());
  take_palette(build, *out);
  const SectionTurn turn(orientation);
  std::map<const RunChunk*, SectionPtr> made;
  const auto done = for_each_section(counts_of(out->cuts()), [&](SectionPos at) -> Result<void> {
    const auto place = by_axis(at);
    std::array<std::uint32_t, 3> from{};
    for (const Axis axis : kTurnAxes) {
      const std::size_t i = index_of_axis(axis), k = index_of_axis(orientation.along(axis));
      const auto last = static_cast<std::uint32_t>(build.cuts()[k].size() - 2);
      from[k] = orientation.flipped(axis) ? last - place[i] : place[i];
    }
    const SectionPtr& old = build.section({from[0], from[1], from[2]});
    if (old->is_uniform()) return out->put(at, turn(*old));
    SectionPtr& section = made[old.get()];
    if (!section) {
      RunChunk cells = turn(*old);
      cells.runs.shrink_to_fit();
      section = std::make_shared<const RunChunk>(std::move(cells));
    }
    return out->put(at, section);
  });
  if (!done) return failure(done.error());
  return out->finish();
}

VoxelPos stack_corner(VoxelPos offset, std::int32_t times) {
  const auto low = [times](std::int32_t way) { return std::min(0, way * times); };
  return {low(offset.x), low(offset.y), low(offset.z)};
}

Result<BuildPtr> stacked(const Build& build, VoxelPos offset, std::int32_t times,
                         std::size_t bytes_max) {
  RUNSTONE_ASSERT(times >= 1);
  if (offset == VoxelPos{}) return fail(ErrorCode::bad_value, "stack has no offset");
  if (const auto fits = check_length(offset, times, build.sides()); !fits)
    return failure(fits.error());
  const std::int32_t copies = times + 1;
  if (const auto row = row_of(offset, build.sides()))
    return stacked_row(build, *row, copies, bytes_max);
  return stacked_anywhere(build, offset, copies, bytes_max);
}

Result<BuildPtr> with_materials(const Build& build,
                                std::span<const std::optional<Material>> palette,
                                std::size_t bytes_max, PaletteOrder order) {
  RUNSTONE_ASSERT(palette.size() == build.palette().size());
  auto out = BuildBuilder::of(build.cuts(), bytes_max);
  if (!out) return failure(out.error());
  if (order == PaletteOrder::ascending) {
    std::vector<std::optional<Material>> sorted(palette.begin(), palette.end());
    std::sort(sorted.begin(), sorted.end());
    for (const auto& material : sorted) {
      if (material) static_cast<void>(out->number_of(*material));
    }
  }
  std::vector<std::uint16_t> numbers = {0};
  for (const auto& material : palette)
    numbers.push_back(material ? out->number_of(*material).value_or(0) : std::uint16_t{0});
  std::map<const RunChunk*, SectionPtr> made;
  const auto done = for_each_section(build.section_counts(), [&](SectionPos at) -> Result<void> {
    const SectionPtr& old = build.section(at);
    if (old->is_uniform())
      return out->put(at, uniform_chunk(old->extent, numbers[old->runs.material(0)]));
    SectionPtr& section = made[old.get()];
    if (section) return out->put(at, section);
    RunBuilder cells(old->extent, old->order);
    for (std::size_t i = 0; i < old->runs.size(); ++i)
      cells.append_to(old->runs.end(i), numbers[old->runs.material(i)]);
    RunChunk renumbered = cells.finish();
    if (renumbered.is_uniform()) return out->put(at, std::move(renumbered));
    renumbered.runs.shrink_to_fit();
    section = std::make_shared<const RunChunk>(std::move(renumbered));
    return out->put(at, section);
  });
  if (!done) return failure(done.error());
  return out->finish();
}

RunChunk overlaid(const RunChunk& below, const RunChunk& above) {
  RUNSTONE_ASSERT(below.extent == above.extent);
  if (above.is_uniform()) return above.runs.material(0) == 0 ? below : above;
  if (above.order != below.order) return overlaid(below, reorder(above, below.order));
  RunBuilder out(below.extent, below.order);
  std::size_t low = 0, high = 0;
  while (out.filled() < below.volume()) {
    const Run under = below.runs[low], over = above.runs[high];
    out.append_to(std::min(under.end, over.end),
                  over.material != 0 ? over.material : under.material);
    if (out.filled() == under.end) ++low;
    if (out.filled() == over.end) ++high;
  }
  return out.finish();
}

}  // namespace runstone
