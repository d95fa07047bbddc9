#include "common/builds/build.hpp"

#include <algorithm>
#include <utility>

#include "common/builds/widened.hpp"
#include "common/core/assert.hpp"
#include "common/runs/cut.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// Returns the section along an axis that holds a coordinate.
std::uint32_t section_along(const std::vector<std::int32_t>& cuts, std::int32_t at) {
  return static_cast<std::uint32_t>(std::upper_bound(cuts.begin(), cuts.end(), at) - cuts.begin() -
                                    1);
}

Extent extent_of_cells(const VoxelBox& box) {
  return {static_cast<std::uint8_t>(box.max.x - box.min.x),
          static_cast<std::uint8_t>(box.max.y - box.min.y),
          static_cast<std::uint8_t>(box.max.z - box.min.z)};
}

LocalPos local_cell(VoxelPos cell, VoxelPos from) {
  return {static_cast<std::uint8_t>(cell.x - from.x), static_cast<std::uint8_t>(cell.y - from.y),
          static_cast<std::uint8_t>(cell.z - from.z)};
}

/// A part of a section, read line by line from its first cell to its last.
struct SectionPart {
  RunChunk cells;
  std::size_t run = 0;
  std::uint32_t at = 0;

  void append_line(std::uint32_t length, RunBuilder& out) {
    while (length != 0) {
      const Run part = cells.runs[run];
      const std::uint32_t count = std::min(length, part.end - at);
      out.append(count, part.material);
      at += count;
      length -= count;
      if (at == part.end) ++run;
    }
  }
};

/// The sections that a box meets.
struct SectionRange {
  SectionPos first, last;  // both included
  bool is_one() const { return first == last; }

  template <class F>
  void for_each(F&& f) const {
    for (SectionPos at{first.x, first.y, first.z}; at.z <= last.z; ++at.z) {
      for (at.y = first.y; at.y <= last.y; ++at.y) {
        for (at.x = first.x; at.x <= last.x; ++at.x) f(at);
      }
    }
  }
};

RunChunk cut_section(const Build& build, SectionPos at, const VoxelBox& box) {
  const VoxelBox section = build.box_of(at);
  const VoxelBox part = intersect(section, box);
  const RunChunk& cells = *build.section(at);
  if (part == section) return cells;
  return cut(cells, local_cell(part.min, section.min), extent_of_cells(part));
}

}  // namespace

std::vector<std::int32_t> grid_cuts(std::int32_t side, std::int32_t edge, std::int32_t offset) {
  RUNSTONE_ASSERT(side > 0 && edge > 0 && edge <= static_cast<std::int32_t>(kSideMax));
  RUNSTONE_ASSERT(offset >= 0 && offset < edge);
  std::vector<std::int32_t> out = {0};
  for (std::int64_t at = edge - offset; at < side; at += edge)
    out.push_back(static_cast<std::int32_t>(at));
  out.push_back(side);
  return out;
}

std::uint64_t Build::volume() const {
  const VoxelPos s = sides();
  return static_cast<std::uint64_t>(s.x) * static_cast<std::uint64_t>(s.y) *
         static_cast<std::uint64_t>(s.z);
}

std::optional<std::uint16_t> Build::number_of(Material material) const {
  const auto found = std::find(palette_.begin(), palette_.end(), material);
  if (found == palette_.end()) return std::nullopt;
  return static_cast<std::uint16_t>(found - palette_.begin() + 1);
}

SectionPos Build::section_counts() const {
  const auto count = [&](std::size_t axis) {
    return static_cast<std::uint32_t>(cuts_[axis].size() - 1);
  };
  return {count(0), count(1), count(2)};
}

VoxelBox Build::box_of(SectionPos at) const {
  return {{cuts_[0][at.x], cuts_[1][at.y], cuts_[2][at.z]},
          {cuts_[0][at.x + 1U], cuts_[1][at.y + 1U], cuts_[2][at.z + 1U]}};
}

SectionPos Build::section_of(VoxelPos cell) const {
  return {section_along(cuts_[0], cell.x), section_along(cuts_[1], cell.y),
          section_along(cuts_[2], cell.z)};
}

std::uint64_t Build::run_count() const {
  std::uint64_t runs = 0;
  for (const SectionPtr& section : sections_) runs += section->runs.size();
  return runs;
}

std::optional<Material> Build::at(VoxelPos cell) const {
  const SectionPos place = section_of(cell);
  const std::uint16_t number = material_at(*section(place), local_cell(cell, box_of(place).min));
  if (number == 0) return std::nullopt;
  return material(number);
}

RunChunk cells_in(const Build& build, const VoxelBox& box) {
  RUNSTONE_ASSERT(!box.empty() && intersect(box, build.box()) == box);
  const SectionRange range{build.section_of(box.min),
                           build.section_of({box.max.x - 1, box.max.y - 1, box.max.z - 1})};
  if (range.is_one()) return cut_section(build, range.first, box);
  // Most boxes of a large build are of one material, and need no lines.
  const RunChunk* richest = build.section(range.first).get();
  const Material number = richest->runs.material(0);
  bool is_uniform = true;
  range.for_each([&](SectionPos at) {
    const RunChunk& cells = *build.section(at);
    is_uniform = is_uniform && cells.is_uniform() && cells.runs.material(0) == number;
    if (cells.runs.size() > richest->runs.size()) richest = &cells;
  });
  const Extent extent = extent_of_cells(box);
  const AxisOrder order = richest->order;
  if (is_uniform) return uniform_chunk(extent, number, order);

  std::vector<SectionPart> parts;  // x fastest, z slowest
  range.for_each(
      [&](SectionPos at) { parts.push_back({reorder(cut_section(build, at, box), order)}); });
  const std::array<std::uint32_t, 3> first = {range.first.x, range.first.y, range.first.z};
  const std::array<std::uint32_t, 3> last = {range.last.x, range.last.y, range.last.z};
  const std::array<std::size_t, 3> steps = {
      1, last[0] - first[0] + 1U, std::size_t{last[0] - first[0] + 1U} * (last[1] - first[1] + 1U)};
  const auto axes = axes_of(order);
  const auto f = static_cast<std::size_t>(axes[0]), m = static_cast<std::size_t>(axes[1]),
             s = static_cast<std::size_t>(axes[2]);
  const std::array<std::int32_t, 3> min = {box.min.x, box.min.y, box.min.z};
  const std::array<std::int32_t, 3> max = {box.max.x, box.max.y, box.max.z};
  const auto side_of = [&](const SectionPart& part) {
    return std::uint32_t{part.cells.extent.sides()[f]};
  };
  RunBuilder out(extent, order);
  std::uint32_t at_s = first[s];
  for (std::int32_t c = min[s]; c < max[s]; ++c) {
    if (c == build.cuts()[s][at_s + 1U]) ++at_s;
    std::uint32_t at_m = first[m];
    for (std::int32_t b = min[m]; b < max[m]; ++b) {
      if (b == build.cuts()[m][at_m + 1U]) ++at_m;
      std::size_t part = (at_s - first[s]) * steps[s] + (at_m - first[m]) * steps[m];
      for (std::uint32_t i = first[f]; i <= last[f]; ++i, part += steps[f])
        parts[part].append_line(side_of(parts[part]), out);
    }
  }
  return out.finish();
}

RunChunk cells_around(const Build& build, const VoxelBox& box) {
  const VoxelBox part = intersect(box, build.box());
  if (part.empty()) return uniform_chunk(extent_of_cells(box), 0);
  return widened(cells_in(build, part), part, box);
}

RunChunk materials_in(const Build& build, const VoxelBox& box) {
  const RunChunk cells = cells_around(build, box);
  RunBuilder out(cells.extent, cells.order);
  cells.runs.visit([&](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::uint16_t number = runs.material(i);
      out.append_to(runs.end(i), number == 0 ? kEmpty : build.material(number));
    }
  });
  return out.finish();
}

}  // namespace runstone
