#include "tests/support/mesh/mesh_scene.hpp"

#include <algorithm>

#include "common/runs/dense.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

const MaterialTable& mesh_materials() {
  static const MaterialTable table = [] {
    MaterialTable t;
    const auto add = [&t](const char* name, Visibility visibility) {
      MaterialInfo info;
      info.name = name;
      info.visibility = visibility;
      RUNSTONE_ASSERT(t.add(info).has_value());
    };
    add("stone", Visibility::opaque);
    add("dirt", Visibility::opaque);
    add("water", Visibility::transparent);
    add("glass", Visibility::transparent);
    add("barrier", Visibility::empty);
    return t;
  }();
  return table;
}

const MaterialTable& many_materials() {
  static const MaterialTable table = [] {
    MaterialTable t;
    for (unsigned id = 1; id < kManyMaterialCount; ++id) {
      MaterialInfo info;
      info.name = "m" + std::to_string(id);
      if (id >= 150) info.visibility = Visibility::transparent;
      RUNSTONE_ASSERT(t.add(info).has_value());
    }
    return t;
  }();
  return table;
}

const VisibilityTable& mesh_visibility() {
  static const VisibilityTable table(visibilities(mesh_materials()));
  return table;
}

const VisibilityTable& many_visibility() {
  static const VisibilityTable table(visibilities(many_materials()));
  return table;
}

MeshNeighbours MeshScene::pointers() const {
  MeshNeighbours out{};
  for (std::size_t d = 0; d < neighbours.size(); ++d) {
    out[d] = neighbours[d] ? &*neighbours[d] : nullptr;
  }
  return out;
}

MeshScene block_scene() {
  MeshScene scene{uniform_chunk(Extent::cube(8), kEmpty), {}};
  for (std::uint8_t z = 3; z < 7; ++z) {
    for (std::uint8_t y = 2; y < 5; ++y)
      fill(scene.chunk, index_of({1, y, z}, Extent::cube(8), AxisOrder::xyz), 2, kStone);
  }
  fill(scene.chunk, index_of({5, 5, 5}, Extent::cube(8), AxisOrder::xyz), 1, kWater);
  return scene;
}

MeshScene random_scene(SplitMix64& rng, unsigned side_max) {
  // Materials beyond the table are opaque to the mesher. Two or three materials make the largest
  // faces.
  const unsigned materials = rng.below(4) == 0 ? 2 + rng.below(12) : kMeshMaterialCount;
  MeshScene scene;
  scene.chunk = random_chunk(rng, side_max, materials);
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    if (rng.below(4) == 0) continue;
    Extent extent = scene.chunk.extent;
    const auto depth = random_extent(rng, side_max).x;
    switch (axis_of(static_cast<Direction>(d))) {
      case Axis::x:
        extent.x = depth;
        break;
      case Axis::y:
        extent.y = depth;
        break;
      case Axis::z:
        extent.z = depth;
        break;
    }
    scene.neighbours[d] = random_chunk(rng, extent, random_order(rng), materials);
  }
  return scene;
}

MeshScene scene_of_extent(SplitMix64& rng, Extent extent, AxisOrder order) {
  MeshScene scene;
  scene.chunk = random_chunk(rng, extent, order, kMeshMaterialCount);
  for (auto& neighbour : scene.neighbours) {
    neighbour = random_chunk(rng, extent, random_order(rng), kMeshMaterialCount, ChunkShape::boxes);
  }
  return scene;
}

MeshScene scene_of_many_materials(SplitMix64& rng, Extent extent, unsigned materials) {
  const auto filled = [&rng, extent, materials] {
    std::vector<Material> voxels(extent.volume());
    for (Material& voxel : voxels) voxel = static_cast<Material>(rng.below(materials));
    for (std::size_t i = 1; i < voxels.size(); i += 3) voxels[i] = voxels[i - 1];
    const AxisOrder order = kAxisOrders[rng.below(kAxisOrderCount)];
    return *from_dense(extent, order, voxels);
  };
  MeshScene scene;
  scene.chunk = filled();
  for (auto& neighbour : scene.neighbours) {
    if (rng.below(4) != 0) neighbour = filled();
  }
  scene.neighbours[rng.below(kDirectionCount)] = scene.chunk;
  return scene;
}

DirtyLayers fill_and_mark(RunChunk& chunk, VoxelIndex first, std::uint32_t count,
                          Material material) {
  const RunChunk before = chunk;
  fill(chunk, first, count, material);
  DirtyLayers dirty;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const LocalPos at = pos_of(i, chunk.extent, chunk.order);
    if (material_at(before, at) == material_at(chunk, at)) continue;
    dirty.layer[0].set(at.x);
    dirty.layer[1].set(at.y);
    dirty.layer[2].set(at.z);
  }
  return dirty;
}

std::vector<UnitFace> expected_faces(const MeshScene& scene, const MaterialTable& materials) {
  std::array<std::optional<DenseChunk>, kDirectionCount> dense;
  DenseNeighbours around{};
  for (std::size_t d = 0; d < dense.size(); ++d) {
    if (!scene.neighbours[d]) continue;
    dense[d] = DenseChunk::of(*scene.neighbours[d]);
    around[d] = &*dense[d];
  }
  return exposed_faces(DenseChunk::of(scene.chunk), around, materials);
}

reference::DenseGrid grid_of(const MeshScene& scene) {
  std::vector<Material> layer;
  reference::DenseGrid grid;
  reference::decode(scene.chunk, scene.pointers(), layer, grid);
  return grid;
}

bool equal_borders(const RunChunk& chunk, const ChunkBorders& a, const ChunkBorders& b) {
  if (a.empty() != chunk.is_uniform() || b.empty() != chunk.is_uniform()) return false;
  for (std::size_t d = 0; d < kDirectionCount && !a.empty(); ++d) {
    const auto side = static_cast<Direction>(d);
    const std::size_t words = a.row_count(side) * a.row_words(side);
    if (a.bit_axis(side) != b.bit_axis(side) || a.row_count(side) != b.row_count(side) ||
        a.row_words(side) != b.row_words(side) ||
        a.has_transparent(side) != b.has_transparent(side) ||
        !std::equal(a.rows(side), a.rows(side) + words, b.rows(side)) ||
        !std::ranges::equal(a.transparent_materials(side), b.transparent_materials(side))) {
      return false;
    }
    if (a.has_transparent(side) &&
        !std::equal(a.transparent_rows(side), a.transparent_rows(side) + words,
                    b.transparent_rows(side)))
      return false;
  }
  return true;
}

ChunkMesh mesh_of(const MeshScene& scene) {
  RdmScratch scratch;
  ChunkMesh mesh;
  mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, mesh);
  return mesh;
}

std::optional<std::string> scene_difference(const MeshScene& scene, const ChunkMesh& mesh) {
  return mesh_difference(mesh, scene.chunk.extent, mesh_materials(), expected_faces(scene));
}

}  // namespace runstone::test
