#include "client/far/tile_mesh.hpp"

#include <algorithm>
#include <array>

#include "client/far/stand_in.hpp"
#include "common/core/tile_keys.hpp"

namespace runstone {
namespace {

constexpr std::array kLateral = {Direction::neg_x, Direction::pos_x, Direction::neg_z,
                                 Direction::pos_z};

/// Appends the waterline of a lateral face: its parts of which the voxel above has another
/// material, one voxel high. `quad` is transparent and faces along x or z.
void append_waterline(const QuadFields& quad, const RunChunk& body, std::vector<Quad>& out) {
  // u and v are y and z for faces along x, and x and y for those along z.
  const bool is_along_x = axis_of(quad.direction) == Axis::x;
  const int height = is_along_x ? quad.width : quad.height;
  const int width = is_along_x ? quad.height : quad.width;
  QuadFields line = quad;
  line.y = static_cast<std::uint8_t>(quad.y + height - 1);
  const auto is_top = [&](int i) {
    if (line.y + 1 == body.extent.y) return true;
    LocalPos above{line.x, static_cast<std::uint8_t>(line.y + 1), line.z};
    (is_along_x ? above.z : above.x) =
        static_cast<std::uint8_t>((is_along_x ? quad.z : quad.x) + i);
    return material_at(body, above) != quad.material;
  };
  for (int first = 0; first < width; ++first) {
    if (!is_top(first)) continue;
    int last = first;
    while (last + 1 < width && is_top(last + 1)) ++last;
    const auto length = static_cast<std::uint8_t>(last + 1 - first);
    QuadFields part = line;
    (is_along_x ? part.z : part.x) =
        static_cast<std::uint8_t>((is_along_x ? quad.z : quad.x) + first);
    (is_along_x ? part.width : part.height) = 1;
    (is_along_x ? part.height : part.width) = length;
    out.push_back(pack(part));
    first = last;
  }
}

/// Replaces the quads of one layer.
void replace_layer(QuadLayers& layers, Direction d, unsigned l, const std::vector<Quad>& quads) {
  const std::size_t i = static_cast<std::size_t>(d) * kSideMax + l;
  const std::uint32_t before = layers.first[i + 1] - layers.first[i];
  const auto after = static_cast<std::uint32_t>(quads.size());
  const auto begin = layers.quads.begin() + layers.first[i];
  layers.quads.insert(layers.quads.erase(begin, begin + before), quads.begin(), quads.end());
  for (std::size_t later = i + 1; later < layers.first.size(); ++later)
    layers.first[later] = layers.first[later] - before + after;
}

/// Leaves of the transparent faces on the border those on top, and the waterlines of the lateral
/// ones.
void trim_border(const RunChunk& body, QuadLayers& transparent) {
  if (transparent.quads.empty()) return;
  replace_layer(transparent, Direction::neg_y, 0, {});
  for (const Direction d : kLateral) {
    const unsigned layer = is_positive(d) ? body.extent.x - 1U : 0;
    std::vector<Quad> lines;
    for (const Quad quad : transparent.layer(d, layer)) append_waterline(unpack(quad), body, lines);
    replace_layer(transparent, d, layer, lines);
  }
}

ChunkMesh mesh_body(const RunChunk& body, const VisibilityTable& visibility, RdmScratch& scratch) {
  ChunkMesh out;
  mesh_rdm(body, {}, visibility, scratch, out);
  trim_border(body, out.transparent);
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

bool drop_water_walls(ChunkMesh& mesh, std::int32_t edge, std::uint8_t sides) {
  const std::size_t before = mesh.transparent.quads.size();
  if (before == 0) return false;
  for (const Direction d : kLateral) {
    if ((sides >> static_cast<unsigned>(d) & 1U) == 0) continue;
    replace_layer(mesh.transparent, d, is_positive(d) ? static_cast<unsigned>(edge - 1) : 0, {});
  }
  return mesh.transparent.quads.size() != before;
}

}  // namespace runstone
