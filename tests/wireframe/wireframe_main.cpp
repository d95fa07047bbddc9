// runstone-wireframe OUT.png: draws one hill in the meshes of three meshers, side by side, and
// their quads.
#include <cstdio>
#include <string>
#include <vector>

#include "bench/worlds/seeded_worlds.hpp"
#include "client/render/png_file.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/runs/reorder.hpp"
#include "tests/reference/culled_mesher.hpp"
#include "tests/reference/rle_rdm.hpp"
#include "tests/wireframe/wireframe.hpp"

namespace {

using namespace runstone;

constexpr unsigned kEdge = 32;
// drawn pixels for each pixel of the image, in each direction; a power of two
constexpr int kFiner = 4;
constexpr int kSide = 560, kHeight = 520, kGap = 16;

struct Named {
  const char* name;
  std::vector<Quad> quads;
};

/// Returns the meshes of the chunk without neighbours.
std::vector<Named> meshes_of(const RunChunk& chunk, const VisibilityTable& visibility) {
  std::vector<Named> out = {{"culled", {}}, {"RLE RDM of the thesis", {}}, {"RDM from runs", {}}};
  reference::DenseGrid grid;
  std::vector<Material> layer;
  reference::decode(chunk, {}, layer, grid);
  reference::mesh_culled(grid, visibility, out[0].quads);
  reference::mesh_rle_rdm(reorder(chunk, AxisOrder::zyx), visibility, out[1].quads);
  RdmScratch scratch;
  ChunkMesh mesh;
  mesh_rdm(chunk, {}, visibility, scratch, mesh);
  out[2].quads = mesh.opaque.quads;
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s OUT.png\n", argv[0]);
    return 2;
  }
  const bench::VoxelWorld world = bench::seeded_worlds().front();
  const RunChunk chunk = bench::chunk_of_world(world, {0, -16, 0}, kEdge);
  const std::vector<Named> meshes = meshes_of(chunk, *world.visibility);
  const int count = static_cast<int>(meshes.size());
  Image image = wireframe::blank((count * kSide + (count + 1) * kGap) * kFiner,
                                 (kHeight + 2 * kGap) * kFiner);
  int left = kGap * kFiner;
  for (const Named& mesh : meshes) {
    wireframe::draw(mesh.quads, {left, kGap * kFiner, kSide * kFiner, kHeight * kFiner}, kFiner,
                    image);
    left += (kSide + kGap) * kFiner;
    std::printf("%s: %zu quads\n", mesh.name, mesh.quads.size());
  }
  for (int finer = kFiner; finer > 1; finer /= 2) image = halved(image);
  const auto written = write_png(argv[1], image);
  if (written) return 0;
  std::fprintf(stderr, "runstone-wireframe: %s\n", written.error().c_str());
  return 1;
}
