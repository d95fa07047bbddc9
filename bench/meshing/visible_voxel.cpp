#include "bench/meshing/visible_voxel.hpp"

#include <array>

namespace runstone::bench {

VisibleVoxel draw_visible_voxel(const ChunkMesh& mesh, SplitMix64& rng) {
  const std::size_t opaque = mesh.opaque.quads.size();
  const std::size_t count = opaque + mesh.transparent.quads.size();
  const std::size_t i = rng.below(static_cast<std::uint32_t>(count));
  const QuadFields q =
      unpack(i < opaque ? mesh.opaque.quads[i] : mesh.transparent.quads[i - opaque]);
  std::array<std::int32_t, 3> at = {q.x, q.y, q.z};
  const Axis axis = axis_of(q.direction);
  at[static_cast<std::size_t>(u_axis_of(axis))] += static_cast<std::int32_t>(rng.below(q.width));
  at[static_cast<std::size_t>(v_axis_of(axis))] += static_cast<std::int32_t>(rng.below(q.height));
  return {{at[0], at[1], at[2]}, q.direction};
}

}  // namespace runstone::bench
