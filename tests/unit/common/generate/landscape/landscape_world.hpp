// Landscapes of the built-in table, for tests.
#pragma once
#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <string>

#include "common/generate/generator.hpp"

namespace runstone::test {

inline std::unique_ptr<Generator> landscape_of(std::uint64_t seed,
                                               const std::string& parameters = "") {
  auto made = make_generator({"landscape", 1, seed, parameters}, landscape_material_table());
  REQUIRE(made.has_value());
  return *std::move(made);
}

inline Material named(const char* name) { return *landscape_material_table().find(name); }

/// Returns the number of voxels of a material.
inline std::size_t count_of(const RunChunk& chunk, Material material) {
  return chunk.runs.visit([&](auto runs) {
    std::size_t out = 0;
    for (std::size_t i = 0, begin = 0; i < runs.size(); begin = runs.end(i++))
      out += runs.material(i) == material ? runs.end(i) - begin : 0;
    return out;
  });
}

/// The voxels of a generator, chunk by chunk.
class LandscapeVoxels {
 public:
  static constexpr std::int32_t kEdge = 32;
  explicit LandscapeVoxels(const Generator& generator) : generator_(generator) {}

  const RunChunk& chunk(ChunkCoord at) {
    auto found = chunks_.find(at);
    if (found == chunks_.end()) {
      found =
          chunks_.emplace(at, generator_.generate(origin_of(at, kEdge), Extent::cube(kEdge))).first;
    }
    return found->second;
  }
  Material at(VoxelPos pos) {
    const ChunkCoord coord = chunk_of(pos, kEdge);
    const VoxelPos origin = origin_of(coord, kEdge);
    return material_at(chunk(coord), {static_cast<std::uint8_t>(pos.x - origin.x),
                                      static_cast<std::uint8_t>(pos.y - origin.y),
                                      static_cast<std::uint8_t>(pos.z - origin.z)});
  }

 private:
  const Generator& generator_;
  std::map<ChunkCoord, RunChunk> chunks_;
};

}  // namespace runstone::test
