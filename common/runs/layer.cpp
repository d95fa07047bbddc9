#include "common/runs/layer.hpp"

#include "common/runs/layer_walk.hpp"

namespace runstone {

void read_layer(const RunChunk& chunk, Axis axis, std::uint32_t at, Axis u_axis,
                std::span<Material> out) {
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const std::array<std::uint32_t, 3> sides = {e.f, e.m, e.s};
  const int rank = rank_of(axis, chunk.order);
  const int faster = rank == 0 ? 1 : 0;
  const int slower = rank == 2 ? 1 : 2;
  const std::uint32_t faster_side = sides[static_cast<std::size_t>(faster)];
  const std::uint32_t slower_side = sides[static_cast<std::size_t>(slower)];
  RUNSTONE_ASSERT(at < sides[static_cast<std::size_t>(rank)] && u_axis != axis);
  RUNSTONE_ASSERT(out.size() == std::size_t{faster_side} * slower_side);

  chunk.runs.visit([&](const auto& runs) {
    if (rank_of(u_axis, chunk.order) == faster) {  // rows of `out` are rows of the walk
      walk_layer(runs, e, rank, at,
                 [&](std::uint32_t slow, std::uint32_t a, std::uint32_t b, Material material) {
                   Material* const row = out.data() + std::size_t{slow} * faster_side;
                   std::fill(row + a, row + b, material);
                 });
      return;
    }
    walk_layer(runs, e, rank, at,
               [&](std::uint32_t slow, std::uint32_t a, std::uint32_t b, Material material) {
                 for (std::uint32_t v = a; v < b; ++v)
                   out[slow + std::size_t{v} * slower_side] = material;
               });
  });
}

}  // namespace runstone
