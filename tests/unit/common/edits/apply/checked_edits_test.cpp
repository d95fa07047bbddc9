#include "common/edits/apply/checked_edits.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("edits and chunks from data are applied, or refused without a change", "[edits]") {
  RunChunk chunk = uniform_chunk(Extent::cube(16), kEmpty);
  Digest digest = digest_of(chunk);
  const RunChunk before = chunk;
  ApplyScratch scratch;
  const EditDescriptor good{SetVoxel{{3, 4, 5}}, {}, 7};
  const EditDescriptor far{FillSphere{{1 << 30, 0, 0}, 2}, {}, 7};
  const EditDescriptor empty{FillBox{{{0, 0, 0}, {0, 4, 4}}}, {}, 7};

  for (const EditDescriptor& bad : {far, empty}) {
    const auto applied = try_apply_stack(chunk, digest, {}, std::array{good, bad}, scratch);
    REQUIRE_FALSE(applied.has_value());
    CHECK(applied.error().offset == 1);
  }
  for (const VoxelPos origin : {VoxelPos{kWorldLimit - 8, 0, 0}, VoxelPos{0, INT32_MIN, 0}})
    CHECK_FALSE(try_apply_stack(chunk, digest, origin, std::array{good}, scratch).has_value());
  RunChunk small = uniform_chunk(Extent::cube(4), kEmpty);
  CHECK_FALSE(try_apply_stack(small, digest, {}, std::array{good}, scratch).has_value());
  CHECK(chunk == before);
  CHECK(digest == digest_of(before));

  const auto applied = try_apply_stack(chunk, digest, {}, std::array{good}, scratch);
  REQUIRE(applied.has_value());
  CHECK(applied->voxels_changed == 1);
  CHECK(material_at(chunk, {3, 4, 5}) == 7);
  CHECK(digest == digest_of(chunk));
}
