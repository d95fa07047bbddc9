// A dense array of voxels becomes runs, and the runs become the quads to draw.
#include <array>
#include <cstdio>
#include <vector>

#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/runs/dense.hpp"

using namespace runstone;

int main() {
  // 0 is empty, 1 is stone, 2 is water. Ids without an entry are opaque.
  const std::array visibility = {Visibility::empty, Visibility::opaque, Visibility::transparent};
  const VisibilityTable table{visibility};

  // 32 x 32 x 32 voxels: stone up to y = 9, and water in one half up to y = 11. x is the fastest
  // axis.
  const Extent extent = Extent::cube(32);
  std::vector<Material> voxels(extent.volume(), kEmpty);
  for (unsigned z = 0; z < 32; ++z) {
    for (unsigned y = 0; y < 12; ++y) {
      for (unsigned x = 0; x < 32; ++x) {
        if (y < 10 || z < 16) voxels[x + 32 * (y + 32 * z)] = y < 10 ? 1 : 2;
      }
    }
  }

  const Result<RunChunk> chunk = from_dense(extent, AxisOrder::xyz, voxels);
  if (!chunk) {  // for example, if the number of voxels is not 32 * 32 * 32
    std::fprintf(stderr, "%s\n", chunk.error().what);
    return 1;
  }
  const MeshNeighbours neighbours{};  // none: the faces at the edge of the chunk are drawn
  RdmScratch scratch;                 // one per thread, reused
  ChunkMesh mesh;
  mesh_rdm(*chunk, neighbours, table, scratch, mesh);

  std::printf("%zu runs, %zu opaque quads, %zu transparent quads\n", chunk->runs.size(),
              mesh.opaque.quads.size(), mesh.transparent.quads.size());
  const QuadFields first = unpack(mesh.opaque.quads.front());
  std::printf("first quad: corner %d %d %d, %d x %d faces of material %d\n", first.x, first.y,
              first.z, first.width, first.height, first.material);
}
