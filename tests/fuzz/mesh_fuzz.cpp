// The target compares meshers with the face oracle on scenes that bytes describe, and remeshing
// with meshing. Every input is a scene and some edits:
//   - 3 bytes sides (8 + b % 9; the first one of 252 .. 255 is 33, 64, 65 or 128);
//   - 1 byte axis order;
//   - 1 byte mask of neighbours (bit 6: every run of stone becomes a material of its own);
//   - per chunk (the chunk itself first) a byte of axis order and depth (neighbours only) and
//     (length, material) byte pairs until it is full; when the bytes end, the rest of a chunk is
//     empty;
//   - kEdits edits of five bytes: which chunk, 2 bytes first voxel, length (below 128: one voxel),
//     material. When the bytes end, the edits are drawn from a generator that the whole input
//     seeds, so that every scene is edited.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>

#include "common/core/hash.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/mesh/mesher_checks.hpp"
#include "tests/support/mesh/polygon_checks.hpp"

namespace {

using namespace runstone;

constexpr int kEdits = 3;

std::uint64_t seed_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t seed = bytes.size();
  for (const std::uint8_t byte : bytes) seed = mix64(seed ^ byte);
  return seed;
}

class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes), rng_(seed_of(bytes)) {}
  bool empty() const { return bytes_.empty(); }
  /// Returns the next byte, or 0 after the end of the input.
  std::uint8_t next() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }
  /// Returns the next byte, or a random one after the end of the input.
  std::uint8_t next_or_drawn() {
    return empty() ? static_cast<std::uint8_t>(rng_.below(256)) : next();
  }

 private:
  std::span<const std::uint8_t> bytes_;
  SplitMix64 rng_;
};

/// One long side suffices for longer rows, and keeps a scene small.
Extent read_extent(Input& in) {
  bool long_side = false;
  const auto side = [&]() -> std::uint8_t {
    constexpr std::array<std::uint8_t, 5> kLong = {32, 33, 64, 65, 128};
    const std::uint8_t byte = in.next();
    if (byte < 251 || long_side) return static_cast<std::uint8_t>(kSideMin + byte % 9);
    long_side = true;
    return kLong[byte - 251u];
  };
  const std::uint8_t x = side();
  const std::uint8_t y = side();
  return {x, y, side()};
}

AxisOrder read_order(Input& in) { return kAxisOrders[in.next() % kAxisOrderCount]; }

/// Returns a neighbour's extent: along its direction as deep as the chunk, deeper, or flatter.
/// `code` is 0 .. 42.
Extent extent_beyond(Extent extent, Axis axis, unsigned code) {
  constexpr std::array<std::uint8_t, 3> kDeep = {64, 65, 128};
  if (code == 0) return extent;
  const auto depth =
      code < 40 ? static_cast<std::uint8_t>(kSideMin + code - 1) : kDeep.at(code - 40);
  (axis == Axis::x ? extent.x : axis == Axis::y ? extent.y : extent.z) = depth;
  return extent;
}

/// `stone` is the material of the next run of stone if each run has one of its own, otherwise
/// nullopt.
RunChunk read_chunk(Input& in, Extent extent, AxisOrder order, std::optional<Material>& stone) {
  RunBuilder builder(extent, order);
  while (!in.empty() && builder.filled() < extent.volume()) {
    // Lengths above 127 count lines and more, so that a few bytes reach whole layers.
    const std::uint8_t byte = in.next();
    const std::uint32_t length = byte < 128 ? byte + 1u : (byte - 127u) * ordered(extent, order).f;
    auto material = static_cast<Material>(in.next() % (test::kMeshMaterialCount + 1));
    if (material == test::kStone && stone) material = (*stone)++;
    builder.append(std::min(length, extent.volume() - builder.filled()), material);
  }
  builder.append_to(extent.volume(), kEmpty);
  return builder.finish();
}

test::MeshScene read_scene(Input& in) {
  const Extent extent = read_extent(in);
  const AxisOrder order = read_order(in);
  const std::uint8_t mask = in.next();
  std::optional<Material> stone;
  if ((mask >> 6 & 1) != 0) stone = static_cast<Material>(test::kMeshMaterialCount);
  test::MeshScene scene{read_chunk(in, extent, order, stone), {}};
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    if ((mask >> d & 1) == 0) continue;
    const std::uint8_t form = in.next();
    const Extent theirs =
        extent_beyond(extent, axis_of(static_cast<Direction>(d)), form / kAxisOrderCount);
    scene.neighbours[d] = read_chunk(in, theirs, kAxisOrders[form % kAxisOrderCount], stone);
  }
  return scene;
}

DirtyLayers read_edit(Input& in, RunChunk& chunk) {
  const std::uint64_t high = in.next_or_drawn();
  const auto first =
      static_cast<std::uint32_t>((high << 8 | in.next_or_drawn()) * chunk.volume() >> 16);
  const std::uint32_t byte = in.next_or_drawn();
  const std::uint32_t length = byte < 128 ? 1 : byte - 126;
  const auto material = static_cast<Material>(in.next_or_drawn() % (test::kMeshMaterialCount + 1));
  return test::fill_and_mark(chunk, first, std::min(length, chunk.volume() - first), material);
}

/// Returns the index of the chunk, or of the neighbour of that direction if there is one.
unsigned read_place(Input& in, const test::MeshScene& scene) {
  const unsigned place = in.next_or_drawn() % 12u;
  return place < kDirectionCount && scene.neighbours[place] ? place : kDirectionCount;
}

void demand(bool right, const char* what) {
  if (right) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

/// Compares quad by quad, in order.
bool equal(const ChunkMesh& a, const ChunkMesh& b) {
  return a.opaque.quads == b.opaque.quads && a.opaque.first == b.opaque.first &&
         a.transparent.quads == b.transparent.quads && a.transparent.first == b.transparent.first;
}

/// The buffers live as long as the program, so that the remains of one input would show in the
/// next.
class Trial {
 public:
  Trial() { plain_.use_plain_path(true); }

  /// Meshes a scene. The oracle checks this mesh and those of all reference meshers; every path
  /// must give the same mesh.
  void mesh(const test::MeshScene& scene) {
    const std::string fault = checks_.fault(scene);
    demand(fault.empty(), fault.c_str());
    const std::string of_polygons = polygon_checks_.fault(
        scene, test::mesh_visibility(), test::mesh_materials(), checks_.exposed());
    demand(of_polygons.empty(), of_polygons.c_str());
    mesh_rdm(scene.chunk, scene.pointers(), test::mesh_visibility(), scratch_, mesh_);
    const auto difference =
        test::mesh_difference(mesh_, scene.chunk.extent, test::mesh_materials(), checks_.exposed());
    demand(!difference, difference.value_or("").c_str());
    demand(mesh_.quad_count() >= checks_.optimal_quads(), "RDM has fewer quads than the optimum");

    mesh_rdm(scene.chunk, scene.pointers(), test::mesh_visibility(), plain_, other_);
    demand(equal(mesh_, other_), "the plain path gives other quads");
    MeshBorders borders{};
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      if (!scene.neighbours[d]) continue;
      kept_[d].read(*scene.neighbours[d], test::mesh_visibility());
      borders[d] = &kept_[d];
    }
    mesh_rdm(scene.chunk, scene.pointers(), borders, test::mesh_visibility(), scratch_, other_,
             &own_);
    demand(equal(mesh_, other_), "kept borders give other quads");
    read_.read(scene.chunk, test::mesh_visibility());
    demand(test::equal_borders(scene.chunk, own_, read_),
           "a mesh makes other borders than its chunk has");
  }

  /// Edits a meshed scene. Remeshing the dirty layers must give the mesh of the whole chunk.
  void edit(Input& in, test::MeshScene& scene) {
    DirtyLayers dirty;
    std::array<DirtyLayers, kDirectionCount> beyond{};
    const unsigned place = read_place(in, scene);
    if (place == kDirectionCount) {
      dirty = read_edit(in, scene.chunk);
    } else {
      beyond[place] = read_edit(in, *scene.neighbours[place]);
    }
    mesh_rdm_layers(scene.chunk, scene.pointers(), test::mesh_visibility(), dirty, beyond, scratch_,
                    mesh_);
    mesh_rdm(scene.chunk, scene.pointers(), test::mesh_visibility(), scratch_, other_);
    demand(equal(mesh_, other_), "remeshed layers differ from a full mesh");
  }

  const ChunkMesh& last() const { return mesh_; }

 private:
  test::MesherChecks checks_;
  test::PolygonChecks polygon_checks_;
  RdmScratch scratch_, plain_;
  ChunkMesh mesh_, other_;
  std::array<ChunkBorders, kDirectionCount> kept_;
  ChunkBorders own_, read_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Trial trial;
  Input in({data, size});
  test::MeshScene scene = read_scene(in);
  trial.mesh(scene);
  for (int i = 0; i < kEdits; ++i) trial.edit(in, scene);
  const auto difference = test::scene_difference(scene, trial.last());
  demand(!difference, difference.value_or("").c_str());
  return 0;
}
