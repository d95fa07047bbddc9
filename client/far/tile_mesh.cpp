#include "client/far/tile_mesh.hpp"

#include <algorithm>

#include "client/far/stand_in.hpp"
#include "common/core/tile_keys.hpp"

namespace runstone {
namespace {

/// Removes the quads of one layer.
void drop_layer(QuadLayers& layers, Direction d, unsigned l) {
  const std::size_t i = static_cast<std::size_t>(d) * kSideMax + l;
  const std::uint32_t count = layers.first[i + 1] - layers.first[i];
  if (count == 0) return;
  const auto begin = layers.quads.begin() + layers.first[i];
  layers.quads.erase(begin, begin + count);
  for (std::size_t later = i + 1; later < layers.first.size(); ++later)
    layers.first[later] -= count;
}

ChunkMesh mesh_body(const RunChunk& body, const VisibilityTable& visibility, RdmScratch& scratch) {
  ChunkMesh out;
  mesh_rdm(body, {}, visibility, scratch, out);
  const unsigned last = body.extent.x - 1U;
  for (const Direction d :
       {Direction::neg_x, Direction::pos_x, Direction::neg_y, Direction::neg_z, Direction::pos_z})
    drop_layer(out.transparent, d, is_positive(d) ? last : 0);
  return out;
}

}  // namespace

std::size_t TileMesh::quad_count() const {
  std::size_t out = whole.quad_count();
  for (const ChunkMesh& octant : octants) out += octant.quad_count();
  return out;
}

FarMeshResult mesh_tile(const FarMeshJob& job, const VisibilityTable& visibility,
                        RdmScratch& scratch) {
  auto mesh = std::make_shared<TileMesh>();
  mesh->whole = mesh_body(*job.tile, visibility, scratch);
  if (job.with_octants && !mesh->empty()) {
    mesh->octants.reserve(kTileChildren);
    for (unsigned i = 0; i < kTileChildren; ++i)
      mesh->octants.push_back(mesh_body(cut_octant(*job.tile, i), visibility, scratch));
  }
  return {job.key, job.number, job.tile->extent.x, std::move(mesh)};
}

}  // namespace runstone
