#include "common/builds/basin_flood.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/core/assert.hpp"
#include "common/core/build_info.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// Makes the build of the empty voxels that a flood reached.
class BasinBuild {
 public:
  BasinBuild(const BasinFlood& flood, std::int32_t edge, const LineFlood& reached)
      : flood_(flood), edge_(edge), reached_(reached), box_(reached.box()) {}

  Result<FloodedBasin, BasinFault> build() const {
    if (box_.empty()) return failure(BasinFault::full);
    const ChunkCoord first = chunk_of(box_.min, edge_);
    if (std::max({box_.max.x - box_.min.x, box_.max.y - box_.min.y, box_.max.z - box_.min.z}) >
        kBuildSideMax)
      return failure(BasinFault::too_many_voxels);
    auto out = BuildBuilder::of(world_cuts(box_, edge_));
    if (!out) return failure(BasinFault::too_many_voxels);
    const std::uint16_t number = *out->number_of(flood_.material);
    for (const auto& [at, lines] : reached_.chunks()) {
      auto cells = cells_of(at, lines, number);
      if (!cells) continue;
      const SectionPos place{static_cast<std::uint32_t>(at.x - first.x),
                             static_cast<std::uint32_t>(at.y - first.y),
                             static_cast<std::uint32_t>(at.z - first.z)};
      if (!out->put(place, *std::move(cells))) return failure(BasinFault::too_many_voxels);
    }
    auto made = out->finish();
    if (!made) return failure(BasinFault::too_many_voxels);
    return FloodedBasin{*std::move(made), box_.min, reached_.voxels()};
  }

 private:
  /// Returns the reached empty voxels of a chunk, within the box, or nullopt if there are none.
  std::optional<RunChunk> cells_of(ChunkCoord at, const LineFlood::Lines& lines,
                                   std::uint16_t number) const {
    const VoxelBox part = intersect(box_, box_of(at, edge_));
    if (part.empty()) return std::nullopt;
    const auto side = [](std::int32_t low, std::int32_t high) {
      return static_cast<std::uint8_t>(high - low);
    };
    const VoxelPos origin = origin_of(at, edge_);
    RunBuilder out(
        {side(part.min.x, part.max.x), side(part.min.y, part.max.y), side(part.min.z, part.max.z)},
        AxisOrder::xyz);
    const auto width = static_cast<std::uint32_t>(part.max.x - part.min.x);
    const std::int32_t x0 = part.min.x - origin.x;
    std::uint32_t line_end = 0;
    bool has_cells = false;
    for (std::int32_t z = part.min.z - origin.z; z < part.max.z - origin.z; ++z) {
      for (std::int32_t y = part.min.y - origin.y; y < part.max.y - origin.y; ++y) {
        const auto line = static_cast<std::size_t>(y + edge_ * z);
        for (std::uint32_t i = lines.begins[line]; i < lines.begins[line + 1]; ++i) {
          const LineFlood::Stretch& s = lines.stretches[i];
          if (!s.is_taken || !s.is_reached) continue;
          // The box holds each reached empty stretch.
          out.append_to(line_end + static_cast<std::uint32_t>(s.first - x0), 0);
          out.append_to(line_end + static_cast<std::uint32_t>(s.last - x0), number);
          has_cells = true;
        }
        line_end += width;
        out.append_to(line_end, 0);
      }
    }
    if (!has_cells) return std::nullopt;
    return out.finish();
  }

  const BasinFlood& flood_;
  const std::int32_t edge_;
  const LineFlood& reached_;
  const VoxelBox box_;
};

BasinFault fault_of(FloodFault fault) {
  switch (fault) {
    case FloodFault::blocked:
      return BasinFault::blocked;
    case FloodFault::missing_chunk:
      return BasinFault::missing_chunk;
    case FloodFault::too_many_voxels:
      break;
  }
  return BasinFault::too_many_voxels;
}

}  // namespace

Result<FloodedBasin, BasinFault> flood_basin(const BasinFlood& flood, std::int32_t edge,
                                             const ChunkLookup& chunk_at) {
  RUNSTONE_ASSERT(flood.material != kEmpty && edge > 0);
  if (flood.start.y > flood.level) return failure(BasinFault::above_level);
  const auto part_of = [&](Material material) {
    if (material == kEmpty) return FloodPart::taken;
    const bool passes = material < flood.passes.size() && flood.passes[material];
    return passes ? FloodPart::passed : FloodPart::stops;
  };
  LineFlood reached(edge, chunk_at, part_of, {flood.level, flood.voxels_max});
  if (const auto fault = reached.run(flood.start)) return failure(fault_of(*fault));
  return BasinBuild(flood, edge, reached).build();
}

}  // namespace runstone
