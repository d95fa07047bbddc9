// Meshers against the face oracle on scenes spelled by bytes, and remeshing against meshing. Every input is a
// scene and some edits:
//   3 bytes sides (8 + b % 9; the first one of 252 .. 255 is 33, 64, 65 or 128), 1 byte axis order, 1 byte
//   mask of neighbours,
//   then per chunk (the chunk itself first) a byte of axis order (neighbours only) and (length, material)
//   byte pairs until it is full; when the bytes run out, the rest of a chunk is empty;
//   then kEdits edits of five bytes: which chunk, 2 bytes first voxel, length (below 128: one
//   voxel), material. When the bytes run
//   out, the edits are drawn from a generator that the whole input seeds, so that every scene is edited.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>

#include "common/core/hash.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/mesh_scene.hpp"
#include "tests/support/mesher_jury.hpp"

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
  /// Zeros behind the end.
  std::uint8_t next() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }
  /// Random bytes behind the end.
  std::uint8_t next_or_drawn() { return empty() ? static_cast<std::uint8_t>(rng_.below(256)) : next(); }

 private:
  std::span<const std::uint8_t> bytes_;
  SplitMix64 rng_;
};

/// One long side is enough for rows of two words, and keeps a scene small.
Extent read_extent(Input& in) {
  bool long_side = false;
  const auto side = [&]() -> std::uint8_t {
    constexpr std::array<std::uint8_t, 4> kLong = {33, 64, 65, 128};
    const std::uint8_t byte = in.next();
    if (byte < 252 || long_side) return static_cast<std::uint8_t>(kSideMin + byte % 9);
    long_side = true;
    return kLong[byte - 252u];
  };
  const std::uint8_t x = side();
  const std::uint8_t y = side();
  return {x, y, side()};
}

AxisOrder read_order(Input& in) { return kAxisOrders[in.next() % kAxisOrderCount]; }

RunChunk read_chunk(Input& in, Extent extent, AxisOrder order) {
  RunBuilder builder(extent, order);
  while (!in.empty() && builder.filled() < extent.volume()) {
    // Lengths above 127 count lines and more, so that a few bytes reach whole layers.
    const std::uint8_t byte = in.next();
    const std::uint32_t length = byte < 128 ? byte + 1u : (byte - 127u) * ordered(extent, order).f;
    const auto material = static_cast<Material>(in.next() % (test::kMeshMaterialCount + 1));
    builder.append(std::min(length, extent.volume() - builder.filled()), material);
  }
  builder.append_to(extent.volume(), kEmpty);
  return builder.finish();
}

test::MeshScene read_scene(Input& in) {
  const Extent extent = read_extent(in);
  const AxisOrder order = read_order(in);
  const std::uint8_t mask = in.next();
  test::MeshScene scene{read_chunk(in, extent, order), {}};
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    if ((mask >> d & 1) == 0) continue;
    const AxisOrder theirs = read_order(in);
    scene.neighbours[d] = read_chunk(in, extent, theirs);
  }
  return scene;
}

DirtyLayers read_edit(Input& in, RunChunk& chunk) {
  const std::uint32_t high = in.next_or_drawn();
  const std::uint32_t first = (high << 8 | in.next_or_drawn()) * chunk.volume() >> 16;
  const std::uint32_t byte = in.next_or_drawn();
  const std::uint32_t length = byte < 128 ? 1 : byte - 126;
  const auto material = static_cast<Material>(in.next_or_drawn() % (test::kMeshMaterialCount + 1));
  return test::fill_and_mark(chunk, first, std::min(length, chunk.volume() - first), material);
}

/// The chunk, or the neighbour of that direction if there is one.
unsigned read_place(Input& in, const test::MeshScene& scene) {
  const unsigned place = in.next_or_drawn() % 12u;
  return place < kDirectionCount && scene.neighbours[place] ? place : kDirectionCount;
}

void demand(bool right, const char* what) {
  if (right) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

/// Quad for quad, in order.
bool equal(const ChunkMesh& a, const ChunkMesh& b) {
  return a.opaque.quads == b.opaque.quads && a.opaque.first == b.opaque.first &&
         a.transparent.quads == b.transparent.quads && a.transparent.first == b.transparent.first;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // What one input leaves behind in buffers would show in the next.
  static test::MesherJury jury;
  static RdmScratch scratch;
  static RdmScratch plain;
  static ChunkMesh mesh;
  static ChunkMesh other;
  plain.use_plain_path(true);
  Input in({data, size});
  test::MeshScene scene = read_scene(in);
  const std::string fault = jury.fault(scene);
  demand(fault.empty(), fault.c_str());
  mesh_rdm(scene.chunk, scene.pointers(), test::mesh_visibility(), scratch, mesh);
  const auto difference =
      test::mesh_difference(mesh, scene.chunk.extent, test::mesh_materials(), jury.exposed());
  demand(!difference, difference.value_or("").c_str());
  mesh_rdm(scene.chunk, scene.pointers(), test::mesh_visibility(), plain, other);
  demand(equal(mesh, other), "the plain path gives other quads");

  for (int i = 0; i < kEdits; ++i) {
    DirtyLayers dirty;
    std::array<DirtyLayers, kDirectionCount> beyond{};
    const unsigned place = read_place(in, scene);
    if (place == kDirectionCount) {
      dirty = read_edit(in, scene.chunk);
    } else {
      beyond[place] = read_edit(in, *scene.neighbours[place]);
    }
    mesh_rdm_layers(scene.chunk, scene.pointers(), test::mesh_visibility(), dirty, beyond, scratch, mesh);
    mesh_rdm(scene.chunk, scene.pointers(), test::mesh_visibility(), scratch, other);
    demand(equal(mesh, other), "remeshed layers differ from a full mesh");
  }
  const auto edited = test::scene_difference(scene, mesh);
  demand(!edited, edited.value_or("").c_str());
  return 0;
}
