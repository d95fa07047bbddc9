// ToolBench: a replica with random or flat ground, and a tool box over it.
#pragma once
#include <catch2/catch.hpp>
#include <utility>
#include <vector>

#include "client/tools/action_source.hpp"
#include "client/tools/tool_box.hpp"
#include "common/core/hash.hpp"
#include "tests/support/codec/chunks_message.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

class ToolBench {
 public:
  static constexpr std::int32_t kEdge = 16;

  ToolBench() {
    replica.set_view({1, {0, 0, 0}, 3, 3});
    static_cast<void>(replica.open({kEdge, 5, 77, 3, 0, 0, 0}));
  }
  void show(ChunkCoord at, RunChunk voxels) {
    ChunkSnapshot snapshot;
    snapshot.key = {0, at};
    snapshot.chunk.voxels = std::move(voxels);
    snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
    replica.receive(chunks_of(std::move(snapshot)), {1000, 1100, 1200});
  }
  /// Shows the chunks -2 .. 1 along each axis: material 1 below y = 0, and nothing above.
  void show_flat() {
    for_each_chunk([&](ChunkCoord at) {
      show(at, uniform_chunk(Extent::cube(kEdge), at.y < 0 ? Material{1} : kEmpty));
    });
  }
  /// Shows the same chunks with random voxels of the materials 0 .. 3.
  void show_random() {
    for_each_chunk([&](ChunkCoord at) {
      const ChunkShape shape = rng.between(0, 1) == 0 ? ChunkShape::boxes : ChunkShape::spheres;
      show(at, random_chunk(rng, Extent::cube(kEdge), random_order(rng), 4, shape));
    });
  }
  /// Returns an aim at a face of a voxel, as a script gives it.
  Aim aim_at(VoxelPos voxel, Direction face, Material held = 2) const {
    Aim aim;
    aim.eye = {voxel.x + 0.5, voxel.y + 5.5, voxel.z + 0.5};
    aim.look = {0, -1, 0};
    aim.held = held;
    aim.hit = RayHit{voxel, replica.shown_at(voxel).value_or(kEmpty), face, 5};
    return aim;
  }
  void predict(const std::vector<EditDescriptor>& edits) {
    for (const EditDescriptor& edit : edits) REQUIRE(replica.predict(edit, 0, 0));
  }
  /// Submits the edits of an action, with those of its pastes.
  void predict(const ToolAction& action) {
    for (const BuildPaste& paste : action.pastes) {
      PasteSource source(paste.build, paste.at, paste.mask, paste.empty,
                         paste_limits(replica.edit_limits()));
      while (const auto edit = source.next()) predict({*edit});
    }
    predict(action.edits);
  }
  Material at(VoxelPos voxel) const { return replica.shown_at(voxel).value_or(kEmpty); }

  SplitMix64 rng{91};
  Replica replica;
  ToolBox box;

 private:
  template <class F>
  static void for_each_chunk(F&& f) {
    for (std::int32_t x = -2; x < 2; ++x) {
      for (std::int32_t y = -2; y < 2; ++y) {
        for (std::int32_t z = -2; z < 2; ++z) f(ChunkCoord{x, y, z});
      }
    }
  }
};

}  // namespace runstone::test
