// TerrainBody: the quads of a chunk, or of a part of a tile, in the buffer of quads, and the orders
// in which they are drawn. TerrainTile: the bodies of a tile.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "client/render/quad_spans.hpp"
#include "client/render/transparent_tree.hpp"
#include "common/core/coords.hpp"

namespace runstone {

struct TerrainBody {
  std::int32_t edge = 0;  // voxels
  QuadSpan quads;         // of both passes
  QuadSpan transparent;   // of cubes and shapes
  QuadSpans opaque;       // of cubes
  QuadSpan shapes;        // the opaque ones
  /// The order of the transparent quads; nullopt if they are too many for a tree.
  std::optional<TransparentTree> tree;
  QuadSpans layers;             // of the transparent quads of cubes, without a tree
  QuadSpan transparent_shapes;  // without a tree
  bool is_glossy = true;        // an opaque quad may have a material that mirrors
  /// Appends the spans of the opaque quads whose faces may be seen from `eye`, and all of shapes.
  void append_opaque(const std::array<double, 3>& eye, std::vector<QuadSpan>& out) const {
    opaque.append_facing(eye, out);
    if (shapes.count != 0) out.push_back(shapes);
  }
};

struct TerrainTile {
  TerrainBody whole;
  std::vector<TerrainBody> octants;  // as in TileMesh
};

/// Returns the smallest corner of a chunk, in world voxels.
inline glm::dvec3 origin_in_world(const ChunkKey& key, std::int32_t edge) {
  const VoxelPos o = origin_of(key.at, edge);
  return {o.x, o.y, o.z};
}

/// Coordinates of patterns, which are fixed to the world, are taken modulo this number of voxels. So
/// a float holds them precisely.
inline constexpr std::int32_t kPatternPeriod = 8192;

/// Returns the smallest corner of a chunk or tile, in voxels of its level modulo kPatternPeriod.
inline glm::vec3 pattern_of(const ChunkKey& key, std::int32_t edge) {
  const VoxelPos o = origin_of(key.at, edge);
  const auto wrap = [](std::int32_t v) { return static_cast<float>(v & (kPatternPeriod - 1)); };
  return {wrap(o.x), wrap(o.y), wrap(o.z)};
}

}  // namespace runstone
