#include "client/far/tile_mesh.hpp"

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

/// Appends the parts of an upper face above which `above` has another material, as strips along z.
/// `above` are the voxels over the body, its lowest ones over the body's highest.
void append_surface(const QuadFields& quad, const RunChunk& above, std::vector<Quad>& out) {
  // u and v are z and x for faces along y.
  const auto is_surface = [&](int x, int z) {
    const LocalPos over{static_cast<std::uint8_t>(x), 0, static_cast<std::uint8_t>(z)};
    return material_at(above, over) != quad.material;
  };
  const std::size_t strips_before = out.size();
  int shown = 0;
  QuadFields strip = quad;
  strip.height = 1;
  for (int x = quad.x; x < quad.x + quad.height; ++x) {
    strip.x = static_cast<std::uint8_t>(x);
    for (int first = quad.z; first < quad.z + quad.width; ++first) {
      if (!is_surface(x, first)) continue;
      int end = first + 1;
      while (end < quad.z + quad.width && is_surface(x, end)) ++end;
      strip.z = static_cast<std::uint8_t>(first);
      strip.width = static_cast<std::uint8_t>(end - first);
      out.push_back(pack(strip));
      shown += end - first;
      first = end;
    }
  }
  if (shown < quad.width * quad.height) return;
  out.resize(strips_before);
  out.push_back(pack(quad));  // nothing covers it
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

/// Leaves of the transparent faces on the border those on top that nothing of the same material covers,
/// and the waterlines of the lateral ones. `above`: the voxels over the body, or null if they are
/// not known.
void trim_border(const RunChunk& body, const RunChunk* above, QuadLayers& transparent) {
  if (transparent.quads.empty()) return;
  replace_layer(transparent, Direction::neg_y, 0, {});
  for (const Direction d : kLateral) {
    const unsigned layer = is_positive(d) ? body.extent.x - 1U : 0;
    std::vector<Quad> lines;
    for (const Quad quad : transparent.layer(d, layer)) append_waterline(unpack(quad), body, lines);
    replace_layer(transparent, d, layer, lines);
  }
  if (above == nullptr) return;
  const unsigned top = body.extent.y - 1U;
  std::vector<Quad> surface;
  for (const Quad quad : transparent.layer(Direction::pos_y, top))
    append_surface(unpack(quad), *above, surface);
  replace_layer(transparent, Direction::pos_y, top, surface);
}

ChunkMesh mesh_body(const RunChunk& body, const RunChunk* above, const VisibilityTable& visibility,
                    RdmScratch& scratch) {
  ChunkMesh out;
  mesh_rdm(body, {}, visibility, scratch, out);
  trim_border(body, above, out.transparent);
  return out;
}

/// The bit of the number of a child that says that it is an upper one (tile_child()).
constexpr unsigned kUpper = 1U << static_cast<unsigned>(Axis::y);

}  // namespace

std::size_t TileMesh::quad_count() const {
  std::size_t out = whole.quad_count();
  for (const ChunkMesh& octant : octants) out += octant.quad_count();
  return out;
}

FarMeshResult mesh_tile(const FarMeshJob& job, const VisibilityTable& visibility,
                        RdmScratch& scratch) {
  auto mesh = std::make_shared<TileMesh>();
  mesh->whole = mesh_body(*job.tile, nullptr, visibility, scratch);
  if (job.with_octants && !mesh->empty()) {
    std::vector<RunChunk> octants;
    octants.reserve(kTileChildren);
    for (unsigned i = 0; i < kTileChildren; ++i) octants.push_back(cut_octant(*job.tile, i));
    mesh->octants.reserve(kTileChildren);
    for (unsigned i = 0; i < kTileChildren; ++i) {
      const RunChunk* const above = (i & kUpper) != 0 ? nullptr : &octants[i | kUpper];
      mesh->octants.push_back(mesh_body(octants[i], above, visibility, scratch));
    }
  }
  return {job.key, job.number, job.tile->extent.x, std::move(mesh)};
}

bool drop_water_walls(ChunkMesh& mesh, std::int32_t edge, std::uint8_t sides) {
  const std::size_t before = mesh.transparent.quads.size();
  if (before == 0) return false;
  const auto drop = [&](Direction d) {
    if ((sides >> static_cast<unsigned>(d) & 1U) == 0) return;
    replace_layer(mesh.transparent, d, is_positive(d) ? static_cast<unsigned>(edge - 1) : 0, {});
  };
  for (const Direction d : kLateral) drop(d);
  drop(Direction::neg_y);
  return mesh.transparent.quads.size() != before;
}

}  // namespace runstone
