#include "client/bots/version_tracker.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr ChunkCoord kHere{0, 0, 0};

ChunkSnapshot snapshot_at(ChunkCoord at, Sequence seq, Epoch epoch = 1) {
  ChunkSnapshot snapshot;
  snapshot.key = {0, at};
  snapshot.chunk.version = {seq == 0 ? 0 : epoch, seq};
  snapshot.chunk.voxels = uniform_chunk(Extent::cube(16), 3);
  snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
  return snapshot;
}

/// Sees one chunk, at this sequence.
VersionTracker book_at(Sequence seq) {
  VersionTracker book;
  book.open(1);
  book.set_view({kHere, 0, 0});
  book.receive(snapshot_at(kHere, seq), 0);
  return book;
}

}  // namespace

TEST_CASE("versions follow edits that continue them", "[bots][light]") {
  VersionTracker book = book_at(4);
  CHECK(book.known() == 1);
  book.follow(kHere, 4, 7, 10);
  book.follow(kHere, 7, 8, 20);
  CHECK(book.version(kHere) == 8);
  CHECK(book.counts().followed == 2);
  CHECK(book.behind() == 0);
  book.tick(kResendUsMax * 10);
  CHECK(book.violations().total() == 0);
}

TEST_CASE("an edit that overtakes its snapshot is held back, one that the snapshot has is dropped",
          "[bots][light]") {
  VersionTracker book;
  book.open(1);
  book.set_view({kHere, 0, 0});
  book.follow(kHere, 2, 3, 10);
  book.follow(kHere, 3, 5, 10);
  book.follow(kHere, 5, 6, 10);
  CHECK(book.known() == 0);
  book.receive(snapshot_at(kHere, 3), 20);
  CHECK(book.version(kHere) == 6);
  CHECK(book.counts().contained == 1);
  CHECK(book.counts().followed == 2);
  book.follow(kHere, 3, 5, 30);
  CHECK(book.counts().contained == 2);
  CHECK(book.behind() == 0);
}

TEST_CASE("a gap is a violation unless the chunk is sent again in time", "[bots][light]") {
  for (const bool resends : {true, false}) {
    CAPTURE(resends);
    VersionTracker book = book_at(4);
    book.follow(kHere, 5, 6, 100);
    CHECK(book.version(kHere) == 4);
    CHECK(book.behind() == 1);
    if (resends) {
      book.receive(snapshot_at(kHere, 6), 1'100);
      CHECK(book.version(kHere) == 6);
      CHECK(book.counts().resent == 1);
      CHECK(book.counts().behind_us.max() == 1'000);
    }
    book.tick(100 + kResendUsMax);
    CHECK(book.violations().total() == (resends ? 0 : 1));
    CHECK(book.violations().all().contains("gap") == !resends);
    CHECK(book.take_requests().size() == (resends ? 0 : 1));
    book.tick(100 + 2 * kResendUsMax);
    CHECK(book.violations().total() == (resends ? 0 : 1));  // told once
  }
}

TEST_CASE("a snapshot that does not close the gap leaves the chunk behind", "[bots][light]") {
  VersionTracker book = book_at(4);
  book.follow(kHere, 6, 7, 100);
  book.receive(snapshot_at(kHere, 5), 200);
  CHECK(book.behind() == 1);
  book.follow(kHere, 7, 9, 250);
  book.receive(snapshot_at(kHere, 6), 300);
  CHECK(book.behind() == 0);
  CHECK(book.version(kHere) == 9);
}

TEST_CASE("an audit tells of edits that never came", "[bots][light]") {
  VersionTracker book = book_at(4);
  book.receive(DigestCheck{{{{0, kHere}, {1, 4}, {}}}}, 10);
  CHECK(book.behind() == 0);
  book.receive(DigestCheck{{{{0, kHere}, {1, 6}, {}}}}, 20);
  CHECK(book.behind() == 1);
  SECTION("the commits were gathered and come") {
    book.follow(kHere, 4, 6, 30);
    CHECK(book.behind() == 0);
  }
  SECTION("they do not") {
    book.tick(20 + kResendUsMax);
    CHECK(book.violations().all().contains("gap"));
  }
}

TEST_CASE("snapshots answer for their digest and epoch", "[bots][light]") {
  VersionTracker book = book_at(4);
  ChunkSnapshot wrong = snapshot_at(kHere, 5);
  wrong.chunk.digest.lane[0] ^= 1;
  book.receive(wrong, 0);
  CHECK(book.violations().all().contains("snapshot digest"));
  CHECK_FALSE(book.violations().all().contains("epoch"));
  book.receive(snapshot_at(kHere, 6, 2), 0);
  CHECK(book.violations().all().contains("epoch"));
  CHECK(book.violations().total() == 2);
}

TEST_CASE("an older snapshot is ignored, and so is what is out of view", "[bots][light]") {
  VersionTracker book = book_at(4);
  book.receive(snapshot_at(kHere, 3), 0);
  CHECK(book.version(kHere) == 4);
  CHECK(book.counts().stale == 1);
  book.receive(snapshot_at({5, 0, 0}, 3), 0);
  book.follow({5, 0, 0}, 8, 9, 0);
  CHECK(book.counts().outside == 1);
  CHECK(book.known() == 1);
  book.follow(kHere, 5, 6, 0);
  book.set_view({{5, 0, 0}, 0, 0});
  CHECK(book.known() == 0);
  CHECK(book.behind() == 0);
}

TEST_CASE("chunks of one material stand for snapshots", "[bots][light]") {
  VersionTracker book;
  book.open(1);
  book.set_view({kHere, 0, 1});
  book.follow(kHere, 4, 6, 0);
  book.receive(
      UniformChunks{{{{0, {0, -1, 0}}, 3, {}}, {{0, kHere}, 0, {1, 4}}, {{0, {0, 1, 0}}, 0, {}}}},
      0);
  CHECK(book.known() == 3);
  CHECK(book.version(kHere) == 6);
  CHECK(book.counts().snapshots == 3);
  CHECK(book.violations().total() == 0);
  book.receive(UniformChunks{{{{0, kHere}, 0, {2, 9}}}}, 0);
  CHECK(book.violations().all().contains("epoch"));
}

TEST_CASE("a chunk that cannot be had counts as known and is not followed", "[bots][light]") {
  VersionTracker book = book_at(4);
  book.follow(kHere, 5, 6, 0);
  book.receive(ChunkUnavailable{{{0, kHere}}, UnavailableReason::damaged});
  CHECK(book.known() == 1);
  CHECK(book.behind() == 0);
  book.follow(kHere, 8, 9, 0);
  CHECK(book.behind() == 0);
  book.receive(snapshot_at(kHere, 9), 0);
  CHECK(book.version(kHere) == 9);
  CHECK(book.known() == 1);
}

TEST_CASE("what is held back is bounded; the newest edit is remembered", "[bots][light]") {
  VersionTracker book;
  book.open(1);
  book.set_view({kHere, 0, 0});
  for (Sequence seq = 2; seq < 2 * kWaitingLinksMax; ++seq) book.follow(kHere, seq - 1, seq, 0);
  book.receive(snapshot_at(kHere, 1), 0);
  CHECK(book.behind() == 1);
  book.receive(snapshot_at(kHere, 2 * kWaitingLinksMax), 0);
  CHECK(book.behind() == 0);
}

TEST_CASE("a new connection expects every chunk anew", "[bots][light]") {
  VersionTracker book = book_at(4);
  book.follow(kHere, 5, 6, 0);
  book.open(2);
  CHECK(book.known() == 0);
  CHECK(book.behind() == 0);
  book.receive(snapshot_at(kHere, 2, 2), 0);
  CHECK(book.version(kHere) == 2);
  CHECK(book.violations().total() == 0);
}
