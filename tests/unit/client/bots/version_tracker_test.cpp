#include "client/bots/version_tracker.hpp"

#include <catch2/catch.hpp>

#include "tests/support/codec/chunks_message.hpp"

using namespace runstone;
using runstone::test::chunks_of;

namespace {

constexpr ChunkCoord kTracked{0, 0, 0};

ChunkSnapshot snapshot_at(ChunkCoord at, Sequence seq, Epoch epoch = 1) {
  ChunkSnapshot snapshot;
  snapshot.key = {0, at};
  snapshot.chunk.version = {seq == 0 ? 0 : epoch, seq};
  snapshot.chunk.voxels = uniform_chunk(Extent::cube(16), 3);
  snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
  return snapshot;
}

/// Makes a tracker of one chunk, at this sequence.
VersionTracker book_at(Sequence seq) {
  VersionTracker tracker;
  tracker.open(1, {});
  tracker.set_view({1, kTracked, 0, 0});
  tracker.receive(chunks_of(snapshot_at(kTracked, seq)), 0);
  return tracker;
}

}  // namespace

TEST_CASE("versions follow edits that continue them", "[bots][headless]") {
  VersionTracker tracker = book_at(4);
  CHECK(tracker.known() == 1);
  tracker.follow(kTracked, 4, 7, 10);
  tracker.follow(kTracked, 7, 8, 20);
  CHECK(tracker.version(kTracked) == 8);
  CHECK(tracker.counts().followed == 2);
  CHECK(tracker.behind() == 0);
  tracker.tick(kResendUsMax * 10);
  CHECK(tracker.violations().total() == 0);
}

TEST_CASE("a far view is complete when all tiles below tiles that are not empty arrived",
          "[bots][headless]") {
  VersionTracker tracker;
  tracker.open(1, {});
  View view{1, kTracked, 2, 2};
  view.levels = 2;
  tracker.set_view(view);
  CHECK_FALSE(tracker.tiles_are_complete());
  const auto answer = [&](const ChunkKey& key, Material material) {
    UniformChunks out;
    out.view = 1;
    out.chunks.push_back({key, material, {}});
    tracker.receive(out, 0);
  };
  const ChunkKey solid{2, {0, 0, 0}};
  for_each_tile(view, {}, 2, [&](const ChunkKey& key) {
    if (key != solid) answer(key, kEmpty);
  });
  CHECK_FALSE(tracker.tiles_are_complete());
  answer(solid, 3);
  CHECK_FALSE(tracker.tiles_are_complete());
  for (unsigned i = 0; i < kTileChildren; ++i) answer(tile_child(solid, i), 3);
  CHECK(tracker.tiles_are_complete());
  tracker.open(1, {});
  CHECK_FALSE(tracker.tiles_are_complete());
}

TEST_CASE("tiles are counted, and one outside of the view is a violation", "[bots][headless]") {
  VersionTracker tracker;
  tracker.open(1, {});
  View view{1, kTracked, 2, 2};
  view.levels = 1;
  tracker.set_view(view);
  ChunkSnapshot tile = snapshot_at({1, 0, 0}, 3);
  tile.key.lod = 1;
  tracker.receive(chunks_of(tile, 1), 0);
  CHECK(tracker.counts().tiles == 1);
  CHECK(tracker.known() == 0);
  CHECK(tracker.violations().total() == 0);
  tile.key.lod = 2;  // the view has one level
  tracker.receive(chunks_of(tile, 1), 0);
  CHECK(tracker.violations().all().at("tile outside").count == 1);
  view.number = 2;
  view.levels = 0;
  tracker.set_view(view);
  tile.key.lod = 1;
  tracker.receive(chunks_of(tile, 1), 0);  // it was on its way
  CHECK(tracker.violations().total() == 1);
}

TEST_CASE("an edit that overtakes its snapshot is held back, and one in the snapshot is dropped",
          "[bots][headless]") {
  VersionTracker tracker;
  tracker.open(1, {});
  tracker.set_view({1, kTracked, 0, 0});
  tracker.follow(kTracked, 2, 3, 10);
  tracker.follow(kTracked, 3, 5, 10);
  tracker.follow(kTracked, 5, 6, 10);
  CHECK(tracker.known() == 0);
  tracker.receive(chunks_of(snapshot_at(kTracked, 3)), 20);
  CHECK(tracker.version(kTracked) == 6);
  CHECK(tracker.counts().contained == 1);
  CHECK(tracker.counts().followed == 2);
  tracker.follow(kTracked, 3, 5, 30);
  CHECK(tracker.counts().contained == 2);
  CHECK(tracker.behind() == 0);
}

TEST_CASE("a gap is a violation unless the chunk is sent again in time", "[bots][headless]") {
  for (const bool resends : {true, false}) {
    CAPTURE(resends);
    VersionTracker tracker = book_at(4);
    tracker.follow(kTracked, 5, 6, 100);
    CHECK(tracker.version(kTracked) == 4);
    CHECK(tracker.behind() == 1);
    if (resends) {
      tracker.receive(chunks_of(snapshot_at(kTracked, 6)), 1'100);
      CHECK(tracker.version(kTracked) == 6);
      CHECK(tracker.counts().resent == 1);
      CHECK(tracker.counts().behind_us.max() == 1'000);
    }
    tracker.tick(100 + kResendUsMax);
    CHECK(tracker.violations().total() == (resends ? 0 : 1));
    CHECK(tracker.violations().all().contains("gap") == !resends);
    CHECK(tracker.take_requests().size() == (resends ? 0 : 1));
    tracker.tick(100 + 2 * kResendUsMax);
    CHECK(tracker.violations().total() == (resends ? 0 : 1));  // reported once
  }
}

TEST_CASE("a snapshot that does not close the gap leaves the chunk behind", "[bots][headless]") {
  VersionTracker tracker = book_at(4);
  tracker.follow(kTracked, 6, 7, 100);
  tracker.receive(chunks_of(snapshot_at(kTracked, 5)), 200);
  CHECK(tracker.behind() == 1);
  tracker.follow(kTracked, 7, 9, 250);
  tracker.receive(chunks_of(snapshot_at(kTracked, 6)), 300);
  CHECK(tracker.behind() == 0);
  CHECK(tracker.version(kTracked) == 9);
}

TEST_CASE("a digest check reveals edits that never arrived", "[bots][headless]") {
  VersionTracker tracker = book_at(4);
  tracker.receive(DigestCheck{{{{0, kTracked}, {1, 4}, {}}}}, 10);
  CHECK(tracker.behind() == 0);
  tracker.receive(DigestCheck{{{{0, kTracked}, {1, 6}, {}}}}, 20);
  CHECK(tracker.behind() == 1);
  SECTION("the commits were gathered and come") {
    tracker.follow(kTracked, 4, 6, 30);
    CHECK(tracker.behind() == 0);
  }
  SECTION("they do not") {
    tracker.tick(20 + kResendUsMax);
    CHECK(tracker.violations().all().contains("gap"));
  }
}

TEST_CASE("a snapshot of a wrong digest or epoch is a violation", "[bots][headless]") {
  VersionTracker tracker = book_at(4);
  ChunkSnapshot wrong = snapshot_at(kTracked, 5);
  wrong.chunk.digest.lane[0] ^= 1;
  tracker.receive(chunks_of(wrong), 0);
  CHECK(tracker.violations().all().contains("snapshot digest"));
  CHECK_FALSE(tracker.violations().all().contains("epoch"));
  tracker.receive(chunks_of(snapshot_at(kTracked, 6, 2)), 0);
  CHECK(tracker.violations().all().contains("epoch"));
  CHECK(tracker.violations().total() == 2);
}

TEST_CASE("an older snapshot is ignored, and so is one out of view", "[bots][headless]") {
  VersionTracker tracker = book_at(4);
  tracker.receive(chunks_of(snapshot_at(kTracked, 3)), 0);
  CHECK(tracker.version(kTracked) == 4);
  CHECK(tracker.counts().stale == 1);
  tracker.receive(chunks_of(snapshot_at({5, 0, 0}, 3)), 0);
  tracker.follow({5, 0, 0}, 8, 9, 0);
  CHECK(tracker.counts().outside == 1);
  CHECK(tracker.known() == 1);
  tracker.follow(kTracked, 5, 6, 0);
  tracker.set_view({2, {5, 0, 0}, 0, 0});
  CHECK(tracker.known() == 0);
  CHECK(tracker.behind() == 0);
}

TEST_CASE("a late snapshot of a chunk that left the view and came back is ignored",
          "[bots][headless]") {
  VersionTracker tracker = book_at(4);
  tracker.set_view({2, {5, 0, 0}, 0, 0});
  tracker.set_view({3, kTracked, 0, 0});
  tracker.receive(chunks_of(snapshot_at(kTracked, 4), 1), 0);
  tracker.receive(UniformChunks{1, {{{0, kTracked}, 3, {}}}}, 0);
  tracker.receive(ChunkUnavailable{1, {{0, kTracked}}, UnavailableReason::damaged});
  CHECK(tracker.known() == 0);
  CHECK(tracker.counts().outside == 3);
  tracker.receive(chunks_of(snapshot_at(kTracked, 5), 3), 0);
  CHECK(tracker.version(kTracked) == 5);
  CHECK(tracker.violations().total() == 0);
}

TEST_CASE("an answer to a view that was not sent is a violation", "[bots][headless]") {
  VersionTracker tracker = book_at(4);
  tracker.receive(chunks_of(snapshot_at(kTracked, 5), 2), 0);
  CHECK(tracker.violations().all().at("view number").count == 1);
}

TEST_CASE("edits in place of a snapshot are a violation", "[bots][headless]") {
  VersionTracker tracker = book_at(4);
  tracker.receive(chunks_of(ChunkEdits{{0, kTracked}, 4, {1, 5}, {}, {{5, {}}}}), 0);
  CHECK(tracker.violations().all().at("chunk edits").count == 1);
  CHECK(tracker.version(kTracked) == 4);
}

TEST_CASE("a view that is complete without all of its chunks is a violation", "[bots][headless]") {
  VersionTracker tracker = book_at(4);
  tracker.complete(1);
  CHECK(tracker.violations().total() == 0);
  tracker.set_view({2, kTracked, 0, 1});
  tracker.complete(1);  // it was sent before the server got the new view
  CHECK(tracker.violations().total() == 0);
  tracker.receive(UniformChunks{2, {{{0, {0, -1, 0}}, 3, {}}}}, 0);
  tracker.complete(2);
  CHECK(tracker.violations().all().at("incomplete view").count == 1);
  tracker.receive(ChunkUnavailable{2, {{0, {0, 1, 0}}}, UnavailableReason::damaged});
  tracker.complete(2);
  CHECK(tracker.violations().total() == 1);
}

TEST_CASE("chunks of one material count as snapshots", "[bots][headless]") {
  VersionTracker tracker;
  tracker.open(1, {});
  tracker.set_view({1, kTracked, 0, 1});
  tracker.follow(kTracked, 4, 6, 0);
  tracker.receive(
      UniformChunks{
          1, {{{0, {0, -1, 0}}, 3, {}}, {{0, kTracked}, 0, {1, 4}}, {{0, {0, 1, 0}}, 0, {}}}},
      0);
  CHECK(tracker.known() == 3);
  CHECK(tracker.version(kTracked) == 6);
  CHECK(tracker.counts().snapshots == 3);
  CHECK(tracker.violations().total() == 0);
  tracker.receive(UniformChunks{1, {{{0, kTracked}, 0, {2, 9}}}}, 0);
  CHECK(tracker.violations().all().contains("epoch"));
}

TEST_CASE("an unavailable chunk counts as known and is not followed", "[bots][headless]") {
  VersionTracker tracker = book_at(4);
  tracker.follow(kTracked, 5, 6, 0);
  tracker.receive(ChunkUnavailable{1, {{0, kTracked}}, UnavailableReason::damaged});
  CHECK(tracker.known() == 1);
  CHECK(tracker.behind() == 0);
  tracker.follow(kTracked, 8, 9, 0);
  CHECK(tracker.behind() == 0);
  tracker.receive(chunks_of(snapshot_at(kTracked, 9)), 0);
  CHECK(tracker.version(kTracked) == 9);
  CHECK(tracker.known() == 1);
}

TEST_CASE("held back edits are bounded, and the newest sequence is remembered",
          "[bots][headless]") {
  VersionTracker tracker;
  tracker.open(1, {});
  tracker.set_view({1, kTracked, 0, 0});
  for (Sequence seq = 2; seq < 2 * kWaitingLinksMax; ++seq)
    tracker.follow(kTracked, seq - 1, seq, 0);
  tracker.receive(chunks_of(snapshot_at(kTracked, 1)), 0);
  CHECK(tracker.behind() == 1);
  tracker.receive(chunks_of(snapshot_at(kTracked, 2 * kWaitingLinksMax)), 0);
  CHECK(tracker.behind() == 0);
}

TEST_CASE("a new connection expects every chunk anew", "[bots][headless]") {
  VersionTracker tracker = book_at(4);
  tracker.follow(kTracked, 5, 6, 0);
  tracker.set_view({2, {5, 0, 0}, 0, 0});
  tracker.set_view({3, kTracked, 0, 0});
  tracker.open(2, {});
  CHECK(tracker.known() == 0);
  CHECK(tracker.behind() == 0);
  tracker.receive(chunks_of(snapshot_at(kTracked, 2, 2)), 0);
  CHECK(tracker.version(kTracked) == 2);
  CHECK(tracker.violations().total() == 0);
}
