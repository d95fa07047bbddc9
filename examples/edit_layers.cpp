// An edit changes a chunk. The result names the layers whose faces have to be meshed again.
#include <array>
#include <cstdio>

#include "common/edits/apply/edit_stack.hpp"

using namespace runstone;

int main() {
  // The chunk at the world's origin, half stone (material 1) and half empty.
  RunChunk chunk = uniform_chunk(Extent::cube(32), kEmpty, AxisOrder::xzy);
  fill(chunk, 0, chunk.volume() / 2, 1);
  Digest digest = digest_of(chunk);
  const VoxelPos origin{0, 0, 0};

  // The edit removes a ball of radius 3 from the surface, but only where there is stone.
  const std::array edits = {
      EditDescriptor{FillSphere{{16, 15, 16}, 3}, {MaskKind::only_material, 1}, kEmpty}};
  ApplyScratch scratch;  // one per thread, reused
  const ApplyResult result = apply_stack(chunk, digest, origin, edits, scratch);

  std::printf("%llu voxels changed, %zu runs now\n",
              static_cast<unsigned long long>(result.voxels_changed), chunk.runs.size());
  const char* names = "xyz";
  for (unsigned axis = 0; axis < 3; ++axis) {
    std::printf("dirty layers along %c:", names[axis]);
    for (unsigned layer = 0; layer < 32; ++layer) {
      if (result.dirty.layer[axis][layer]) std::printf(" %u", layer);
    }
    std::printf("\n");
  }
  return digest == digest_of(chunk) ? 0 : 1;
}
