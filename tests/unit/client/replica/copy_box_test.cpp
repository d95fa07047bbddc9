#include "client/replica/copy_box.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "common/builds/paste_source.hpp"
#include "common/core/hash.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "tests/support/builds/cell_grid.hpp"
#include "tests/support/codec/authority_model.hpp"
#include "tests/support/codec/chunks_message.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kCopyEdge = 16;
const Arrival kNow{1000, 1100, 1200};

struct CopyFixture {
  CopyFixture() {
    replica.set_view({1, {0, 0, 0}, 3, 3});
    static_cast<void>(replica.open({kCopyEdge, 5, 77, 3, 0, 0, 0}));
  }
  /// Shows the chunks -2 to 1 around the origin, with random voxels and axis orders.
  void load() {
    for (std::int32_t x = -2; x < 2; ++x) {
      for (std::int32_t y = -2; y < 2; ++y) {
        for (std::int32_t z = -2; z < 2; ++z) {
          ChunkSnapshot snapshot;
          snapshot.key = {0, {x, y, z}};
          snapshot.chunk.voxels =
              random_chunk(rng, Extent::cube(kCopyEdge), random_order(rng), 4, ChunkShape::boxes);
          snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
          replica.receive(test::chunks_of(std::move(snapshot)), kNow);
        }
      }
    }
  }
  std::string error_of(const VoxelBox& box) const {
    const auto copied = copy_box(replica, box);
    return copied ? "copied" : copied.error().what;
  }
  SplitMix64 rng{51};
  Replica replica;
};

}  // namespace

TEST_CASE_METHOD(CopyFixture, "a copy has the shown voxels of its box", "[replica]") {
  load();
  for (int round = 0; round < 60; ++round) {
    const auto low = [&] { return rng.between(-32, 31); };
    const VoxelPos min{low(), low(), low()};
    const auto end = [&](std::int32_t from) {
      return rng.between(from + 1, std::min(from + 40, 32));
    };
    const VoxelBox box{min, {end(min.x), end(min.y), end(min.z)}};
    const auto copied = copy_box(replica, box);
    REQUIRE(copied);
    REQUIRE(broken_invariant(**copied) == "");
    REQUIRE((*copied)->volume() == (*copied)->touched());
    for (VoxelPos p = box.min; p.x < box.max.x; ++p.x) {
      for (p.y = box.min.y; p.y < box.max.y; ++p.y) {
        for (p.z = box.min.z; p.z < box.max.z; ++p.z)
          REQUIRE((*copied)->at({p.x - min.x, p.y - min.y, p.z - min.z}) == replica.shown_at(p));
      }
    }
  }
}

TEST_CASE_METHOD(CopyFixture, "a copy pasted where it was changes nothing", "[replica]") {
  load();
  const VoxelBox box{{-20, -7, -30}, {25, 30, 31}};
  PasteLimits limits;
  limits.chunk_edge = kCopyEdge;
  limits.clipboard_bytes_max = 2000;
  for (const EmptyCells empty : {EmptyCells::pasted, EmptyCells::skipped}) {
    const auto copied = copy_box(replica, box);
    REQUIRE(copied.has_value());
    PasteSource source(*copied, box.min, {}, empty, limits);
    ApplyScratch scratch;
    int edits = 0;
    while (const auto edit = source.next()) {
      ++edits;
      for (const ChunkCoord at : touched_chunks(*edit, kCopyEdge)) {
        RunChunk chunk = *replica.shown({0, at});
        Digest digest;
        CHECK_FALSE(
            apply_stack(chunk, digest, origin_of(at, kCopyEdge), {&*edit, 1}, scratch).changed);
      }
    }
    CHECK(edits > 1);
  }
}

TEST_CASE_METHOD(CopyFixture, "a copy that cannot be made returns the reason", "[replica]") {
  CHECK(copy_box(Replica{}, {{0, 0, 0}, {1, 1, 1}}).error().what ==
        std::string("no world is open"));
  load();
  CHECK(error_of({{0, 0, 0}, {32, 32, 33}}) == "a chunk of the box to copy is not loaded");
  CHECK(error_of({{-33, 0, 0}, {1, 1, 1}}) == "a chunk of the box to copy is not loaded");
  CHECK(error_of({{0, 0, 0}, {0, 1, 1}}) == "box to copy is empty");
  CHECK(error_of({{INT32_MIN, 0, 0}, {INT32_MAX, 1, 1}}) ==
        "box to copy reaches outside the world");
  CHECK(error_of({{-kWorldLimit, 0, 0}, {kWorldLimit, 64, 64}}) ==
        "build is longer than 1,048,576 voxels");
  CHECK(error_of({{0, 0, 0}, {1 << 20, 1 << 10, 1 << 20}}) == "build takes too much memory");
  const auto small = copy_box(replica, {{-20, -7, -30}, {25, 30, 31}}, 2000);
  REQUIRE_FALSE(small);
  CHECK(small.error().code == ErrorCode::limit_exceeded);
}

}  // namespace runstone::test
