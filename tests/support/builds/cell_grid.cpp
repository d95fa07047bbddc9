#include "tests/support/builds/cell_grid.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "common/builds/build_builder.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

CellGrid::CellGrid(VoxelPos sides)
    : sides_(sides),
      cells_(static_cast<std::size_t>(sides.x) * static_cast<std::size_t>(sides.y) *
             static_cast<std::size_t>(sides.z)) {
  count_dense_expansion();
}

bool CellGrid::any() const {
  return std::any_of(cells_.begin(), cells_.end(), [](GridCell cell) { return cell.has_value(); });
}

CellGrid random_cells(SplitMix64& rng, VoxelPos sides, unsigned materials) {
  CellGrid out(sides);
  const auto random_cell = [&]() -> GridCell {
    if (rng.between(0, 4) == 0) return std::nullopt;
    return static_cast<Material>(rng.between(0, static_cast<std::int32_t>(materials) - 1));
  };
  const auto random_place = [&] {
    return VoxelPos{rng.between(0, sides.x - 1), rng.between(0, sides.y - 1),
                    rng.between(0, sides.z - 1)};
  };
  for (int i = rng.between(1, 12); i > 0; --i) {
    const VoxelPos a = random_place(), b = random_place();
    const GridCell cell = random_cell();
    for_each_cell(sides, [&](VoxelPos c) {
      if (c.x >= std::min(a.x, b.x) && c.x <= std::max(a.x, b.x) && c.y >= std::min(a.y, b.y) &&
          c.y <= std::max(a.y, b.y) && c.z >= std::min(a.z, b.z) && c.z <= std::max(a.z, b.z))
        out.set(c, cell);
    });
  }
  for (int i = rng.between(0, 60); i > 0; --i) out.set(random_place(), random_cell());
  if (!out.any()) out.set(random_place(), Material{1});
  return out;
}

BuildCuts random_cuts(SplitMix64& rng, VoxelPos sides, std::int32_t distance_max) {
  BuildCuts out;
  const std::array<std::int32_t, 3> ends = {sides.x, sides.y, sides.z};
  for (std::size_t i = 0; i < 3; ++i) {
    out[i].push_back(0);
    while (out[i].back() != ends[i])
      out[i].push_back(std::min(ends[i], out[i].back() + rng.between(1, distance_max)));
  }
  return out;
}

BuildPtr build_of_cells(SplitMix64& rng, const CellGrid& cells, const BuildCuts& cuts) {
  auto out = BuildBuilder::of(cuts);
  for (SectionPos at; at.z + 1U < cuts[2].size(); ++at.z) {
    for (at.y = 0; at.y + 1U < cuts[1].size(); ++at.y) {
      for (at.x = 0; at.x + 1U < cuts[0].size(); ++at.x) {
        const VoxelPos low{cuts[0][at.x], cuts[1][at.y], cuts[2][at.z]};
        const Extent extent{static_cast<std::uint8_t>(cuts[0][at.x + 1U] - low.x),
                            static_cast<std::uint8_t>(cuts[1][at.y + 1U] - low.y),
                            static_cast<std::uint8_t>(cuts[2][at.z + 1U] - low.z)};
        const AxisOrder order = random_order(rng);
        RunBuilder runs(extent, order);
        for (std::uint32_t i = 0; i < extent.volume(); ++i) {
          const VoxelPos local = dense_pos(extent, order, i);
          const GridCell cell = cells.at({low.x + local.x, low.y + local.y, low.z + local.z});
          runs.append(1, cell ? *out->number_of(*cell) : std::uint16_t{0});
        }
        if (const auto put = out->put(at, runs.finish()); !put) return nullptr;
      }
    }
  }
  auto made = out->finish();
  return made ? *std::move(made) : nullptr;
}

CellGrid cells_of(const Build& build) {
  CellGrid out(build.sides());
  for_each_cell(out.sides(), [&](VoxelPos c) { out.set(c, build.at(c)); });
  return out;
}

CellGrid turned_cells(const CellGrid& cells, const Orientation& orientation) {
  // The clipboard axes along world x, y and z, by the number of the axis order.
  constexpr std::array<std::array<std::size_t, 3>, 6> kAxesAlong = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  const auto& along = kAxesAlong[static_cast<std::size_t>(orientation.axes)];
  const std::array<std::int32_t, 3> old = {cells.sides().x, cells.sides().y, cells.sides().z};
  CellGrid out({old[along[0]], old[along[1]], old[along[2]]});
  for_each_cell(out.sides(), [&](VoxelPos c) {
    const std::array<std::int32_t, 3> place = {c.x, c.y, c.z};
    std::array<std::int32_t, 3> from{};
    for (std::size_t i = 0; i < 3; ++i) {
      const bool is_flipped = (orientation.flips & (1U << i)) != 0;
      from[along[i]] = is_flipped ? old[along[i]] - 1 - place[i] : place[i];
    }
    out.set(c, cells.at({from[0], from[1], from[2]}));
  });
  return out;
}

std::string broken_invariant(const Build& build) {
  const SectionPos counts = build.section_counts();
  std::uint64_t touched = 0, solid = 0;
  std::vector<bool> is_used(build.palette().size() + 1, false);
  for (SectionPos at; at.z < counts.z; ++at.z) {
    for (at.y = 0; at.y < counts.y; ++at.y) {
      for (at.x = 0; at.x < counts.x; ++at.x) {
        const RunChunk& cells = *build.section(at);
        const VoxelBox box = build.box_of(at);
        if (cells.extent.x != box.max.x - box.min.x || cells.extent.y != box.max.y - box.min.y ||
            cells.extent.z != box.max.z - box.min.z)
          return "a section has other sides than its place";
        if (const auto ok = validate_runs(cells); !ok) return ok.error().what;
        for (std::size_t i = 0; i < cells.runs.size(); ++i) {
          const std::uint16_t number = cells.runs.material(i);
          if (number > build.palette().size()) return "a cell number lies outside the palette";
          is_used[number] = true;
          if (number == 0) continue;
          const std::uint32_t count = cells.runs.end(i) - cells.runs.begin(i);
          touched += count;
          if (build.material(number) != kEmpty) solid += count;
        }
      }
    }
  }
  if (touched != build.touched()) return "the number of touched cells is wrong";
  if (solid != build.solid()) return "the number of solid cells is wrong";
  if (std::find(is_used.begin() + 1, is_used.end(), false) != is_used.end())
    return "the palette has an unused material";
  std::vector<Material> palette = build.palette();
  std::sort(palette.begin(), palette.end());
  if (std::adjacent_find(palette.begin(), palette.end()) != palette.end())
    return "the palette has a material twice";
  std::size_t bytes = sizeof(Build) + build.grid().size() * 4 + palette.size() * 2;
  for (const auto& along : build.cuts()) bytes += along.size() * 4;
  for (const SectionPtr& section : build.distinct_sections())
    bytes += sizeof(RunChunk) + section->runs.byte_capacity();
  return build.memory_bytes() < bytes ? "the bytes of memory are too few" : "";
}

}  // namespace runstone::test
