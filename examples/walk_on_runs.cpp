// A body falls onto stone and slides along a wall. The queries read runs; nothing is unpacked.
#include <cstdio>

#include "common/collision/sweep.hpp"

using namespace runstone;

/// A world of one chunk at the origin, with empty chunks around it.
class OneChunk final : public VoxelSpace {
 public:
  explicit OneChunk(const RunChunk& chunk) : VoxelSpace(chunk.extent.x), chunk_(chunk) {}
  const RunChunk* chunk(ChunkCoord at) const override {
    return at == ChunkCoord{0, 0, 0} ? &chunk_ : &empty_;
  }

 private:
  const RunChunk& chunk_;
  RunChunk empty_ = uniform_chunk(Extent::cube(32), kEmpty);
};

int main() {
  // Stone (material 1) in the lower half, and a wall: the layer x = 20. With the order zyx a layer
  // of x is one stretch of voxels.
  RunChunk chunk = uniform_chunk(Extent::cube(32), kEmpty, AxisOrder::zyx);
  for (unsigned x = 0; x < 32; ++x) fill(chunk, x * 32 * 32, x == 20 ? 32 * 32 : 16 * 32, 1);
  const OneChunk world(chunk);
  const MaterialSet solid;  // every material but the empty one

  const BodyBox body{{10.2, 20, 10.2}, {10.8, 21.8, 10.8}};
  const auto ground = sweep(world, solid, body, {0, -10, 0});
  std::printf("ground after %.1f of 10 voxels\n", ground ? ground->fraction * 10 : 10);

  const Slide along = slide(world, solid, body, {12, 0, 3});
  std::printf("moved %.1f %.1f %.1f, stopped by the wall: %s\n", along.moved.x, along.moved.y,
              along.moved.z,
              along.is_stopped[static_cast<std::size_t>(Direction::pos_x)] ? "yes" : "no");
  return ground ? 0 : 1;
}
