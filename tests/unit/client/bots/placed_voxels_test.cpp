#include "client/bots/placed_voxels.hpp"

#include <catch2/catch.hpp>

#include "tests/support/codec/chunks_message.hpp"

using namespace runstone;

namespace {

/// Loads an empty chunk of edge 32 at the origin.
void load_empty_chunk(Replica& replica) {
  replica.set_view({1, {0, 0, 0}, 0, 0});
  replica.open({.chunk_edge = 32, .author = 1, .instance = 1, .epoch = 1});
  ChunkSnapshot snapshot;
  snapshot.key = {0, {0, 0, 0}};
  snapshot.chunk.voxels = uniform_chunk(Extent::cube(32), kEmpty);
  replica.receive(test::chunks_of(std::move(snapshot)), {});
}

EditDescriptor voxel(std::int32_t x, Material material) {
  return {SetVoxel{{x, 1, 1}}, {}, material};
}

}  // namespace

TEST_CASE("it is known which of the placed voxels are intact", "[bots]") {
  Replica replica;
  load_empty_chunk(replica);
  PlacedVoxels voxels;
  const auto set = [&](const EditDescriptor& edit) {
    REQUIRE(replica.predict(edit, 0, 0).has_value());
    voxels.add(edit);
  };
  set(voxel(1, 5));
  set(voxel(2, 5));
  set(voxel(2, 6));                                         // the last edit of a voxel counts
  set(voxel(40, 7));                                        // in a chunk that is not loaded
  REQUIRE(replica.predict(voxel(1, 9), 0, 0).has_value());  // an edit of another author
  const auto standing = voxels.compare(replica);
  CHECK(standing.held == 3);
  CHECK(standing.intact == 1);
  CHECK(standing.changed == 1);
  CHECK(standing.unseen == 1);
}

TEST_CASE("placed voxels are forgotten that other edits may have changed, and rejected ones",
          "[bots]") {
  Replica replica;
  load_empty_chunk(replica);
  PlacedVoxels voxels;
  voxels.add(voxel(1, 5));
  voxels.add(voxel(2, 5));
  voxels.add(voxel(9, 5));
  voxels.add({FillBox{{{0, 0, 0}, {2, 4, 4}}}, {}, 3});
  CHECK(voxels.compare(replica).held == 2);
  voxels.add({SetVoxel{{2, 1, 1}}, {MaskKind::only_empty, kEmpty}, 3});
  CHECK(voxels.compare(replica).held == 1);
  voxels.forget(voxel(9, 5));
  CHECK(voxels.compare(replica).held == 0);
}
