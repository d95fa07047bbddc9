// BeyondBorder: the materials of the voxels beyond the six sides of a chunk. Internal to the mesher
// of shapes.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/shapes/face_lists.hpp"

namespace runstone::shape_mesh {

class BeyondBorder {
 public:
  /// Begins a chunk. Requires neighbours that outlive the use.
  void begin(const RunChunk& chunk, const MeshNeighbours& neighbours);

  /// Returns the material of the voxel beyond a voxel at the border in direction d, or kEmpty if
  /// there is no neighbour. `place` has the coordinates of the voxel in the bits of a quad. Cost:
  /// O(log runs) for the first kLookups voxels of a side, then one read_layer() and O(1).
  Material at(Direction d, std::uint64_t place) {
    Side& side = sides_[static_cast<std::size_t>(d)];
    const std::uint64_t u = place >> side.u_shift & 127, v = place >> side.v_shift & 127;
    if (!side.layer.empty()) return side.layer[static_cast<std::size_t>(u + side.width * v)];
    return look_up(d, static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(v));
  }

 private:
  static constexpr unsigned kLookups = 16;
  struct Side {
    const RunChunk* chunk = nullptr;
    unsigned u_shift = 0, v_shift = 0;
    std::uint32_t width = 0;  // along u
    unsigned lookups = 0;
    std::vector<Material> layer;  // as read_layer() writes it; empty: not read
  };
  Material look_up(Direction d, std::uint8_t u, std::uint8_t v);

  std::array<Side, kDirectionCount> sides_;
};

}  // namespace runstone::shape_mesh
