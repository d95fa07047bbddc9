#include "server/history/build_at.hpp"

#include <array>
#include <optional>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/core/build_info.hpp"
#include "common/formats/block_assembler.hpp"
#include "common/runs/cut.hpp"

namespace runstone {
namespace {

std::optional<std::string> box_refusal(const VoxelBox& box) {
  if (box.empty()) return "the box is empty";
  const std::array<std::pair<std::int64_t, std::int64_t>, 3> axes = {
      {{box.min.x, box.max.x}, {box.min.y, box.max.y}, {box.min.z, box.max.z}}};
  for (const auto& [min, max] : axes) {
    if (min < -kWorldLimit || max > kWorldLimit)
      return "the box does not lie in the world: coordinates are " + std::to_string(-kWorldLimit) +
             " to " + std::to_string(kWorldLimit - 1);
    if (max - min > kBuildSideMax)
      return "the box is longer than " + std::to_string(kBuildSideMax) + " voxels";
  }
  return std::nullopt;
}

/// Returns the cells of a chunk's part as numbers of the builder, or nullopt if its palette is full.
std::optional<RunChunk> cells_of(const RunChunk& part, BuildBuilder& builder,
                                 std::vector<std::uint16_t>& numbers) {
  for (std::size_t i = 0; i < part.runs.size(); ++i) {
    const Material material = part.runs.material(i);
    if (material >= numbers.size()) numbers.resize(material + 1U, 0);
    if (numbers[material] != 0) continue;
    const auto number = builder.number_of(material);
    if (!number) return std::nullopt;
    numbers[material] = *number;
  }
  return with_materials(part, numbers);
}

FileBuild file_build(BuildPtr build, const MaterialTable& materials, VoxelPos origin) {
  FileBuild out;
  const VoxelPos sides = build->sides();
  out.info.name = "build";
  out.info.origin = origin;
  out.info.sides = {static_cast<std::uint32_t>(sides.x), static_cast<std::uint32_t>(sides.y),
                    static_cast<std::uint32_t>(sides.z)};
  for (const Material material : build->palette()) {
    MaterialRow row;
    row.name = "material " + std::to_string(material);
    if (materials.knows(material)) row = row_of(materials[material]);
    out.materials.push_back({std::move(row), {}});
  }
  out.build = std::move(build);
  return out;
}

}  // namespace

Result<FileBuild, std::string> build_at(const WorldAt& world, WorldReader& reader,
                                        const MaterialTable& materials, const VoxelBox& box,
                                        std::int32_t chunk_edge, std::size_t bytes_max,
                                        const ChunkProgress& progress) {
  if (auto why = box_refusal(box)) return failure(*std::move(why));
  auto builder = BuildBuilder::of(world_cuts(box, chunk_edge), bytes_max);
  if (!builder) return failure(std::string(builder.error().what));
  const BuildCuts cuts = builder->cuts();
  const ChunkCoord first = chunk_of(box.min, chunk_edge);
  const std::uint64_t total =
      (cuts[0].size() - 1) * std::uint64_t{cuts[1].size() - 1} * (cuts[2].size() - 1);
  std::vector<std::uint16_t> numbers;  // by material
  ReplayScratch scratch;
  std::uint64_t done = 0;
  for (SectionPos at; at.z + 1 < cuts[2].size(); ++at.z) {
    for (at.y = 0; at.y + 1 < cuts[1].size(); ++at.y) {
      for (at.x = 0; at.x + 1 < cuts[0].size(); ++at.x) {
        if (!progress(done++, total)) return failure("it was ended");
        const ChunkCoord chunk{first.x + static_cast<std::int32_t>(at.x),
                               first.y + static_cast<std::int32_t>(at.y),
                               first.z + static_cast<std::int32_t>(at.z)};
        const auto voxels = world.voxels({0, chunk}, reader, scratch);
        if (!voxels) return failure(voxels.error().message());
        const VoxelPos low{box.min.x + cuts[0][at.x], box.min.y + cuts[1][at.y],
                           box.min.z + cuts[2][at.z]};
        const Extent extent{static_cast<std::uint8_t>(cuts[0][at.x + 1] - cuts[0][at.x]),
                            static_cast<std::uint8_t>(cuts[1][at.y + 1] - cuts[1][at.y]),
                            static_cast<std::uint8_t>(cuts[2][at.z + 1] - cuts[2][at.z])};
        auto cells = cells_of(cut(*voxels, local_of(low, chunk_edge), extent), *builder, numbers);
        if (!cells) return failure("the box has more materials than a build can have");
        if (const auto put = builder->put(at, *std::move(cells)); !put)
          return failure(std::string(put.error().what));
      }
    }
  }
  auto made = builder->finish();
  if (!made) return failure(std::string(made.error().what));
  return file_build(*std::move(made), materials, box.min);
}

}  // namespace runstone
