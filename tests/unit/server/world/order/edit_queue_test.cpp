#include "server/world/order/edit_queue.hpp"

#include <catch2/catch.hpp>

#include "common/runs/run_builder.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

using Operations = std::vector<std::pair<AuthorId, ClientSequence>>;

EditOffer cheap_offer(AuthorId author, ClientSequence seq) {
  return {{author, 1, seq}, Cause::player, 0, {SetVoxel{{1, 1, 1}}, {}, 1}, 0};
}

/// Returns an edit that touches 48 x 48 chunks of edge 16.
EditOffer costly_offer(AuthorId author, ClientSequence seq) {
  return {{author, 1, seq}, Cause::player, 0, {FillBox{{{0, 0, 0}, {768, 1, 768}}}, {}, 1}, 0};
}

Operations taken(EditQueue& queue, std::uint64_t large_room = kAllLargeEdits) {
  Operations out;
  for (const EditOffer& offer : queue.take(large_room))
    out.emplace_back(offer.op.author, offer.op.seq);
  return out;
}

}  // namespace

TEST_CASE("clients take turns with their edits, each in its own order", "[world]") {
  EditQueue queue(16);
  for (ClientSequence seq = 1; seq <= 3; ++seq) queue.push(cheap_offer(1, seq));
  queue.push(cheap_offer(2, 9));
  queue.push(cheap_offer(3, 4));
  CHECK(queue.size() == 5);
  CHECK(queue.bytes() > 5 * sizeof(EditDescriptor));
  CHECK(taken(queue) == Operations{{1, 1}, {2, 9}, {3, 4}, {1, 2}, {1, 3}});
  CHECK(queue.size() == 0);
  CHECK(queue.bytes() == 0);
  CHECK(queue.take().empty());
}

TEST_CASE("costly edits do not keep the edits of others waiting", "[world]") {
  EditQueue queue(16);
  for (ClientSequence seq = 1; seq <= 3; ++seq) {
    queue.push(costly_offer(1, seq));
    queue.push(costly_offer(2, seq));
  }
  for (ClientSequence seq = 1; seq <= 20; ++seq) queue.push(cheap_offer(3, seq));
  CHECK(taken(queue) == Operations{{1, 1}});
  queue.push(cheap_offer(4, 1));
  CHECK(taken(queue) == Operations{{2, 1}});
  const Operations cheap = taken(queue);
  CHECK(cheap.size() == 21);
  CHECK(cheap[1] == std::pair<AuthorId, ClientSequence>{4, 1});
  CHECK(taken(queue) == Operations{{1, 2}});
  CHECK(taken(queue) == Operations{{2, 2}});
  CHECK(taken(queue) == Operations{{1, 3}});
  CHECK(taken(queue) == Operations{{2, 3}});
  CHECK(queue.size() == 0);
}

TEST_CASE("cheap edits without end do not keep a costly one waiting", "[world]") {
  EditQueue queue(16);
  queue.push(cheap_offer(1, 1));
  queue.push(costly_offer(2, 1));
  CHECK(taken(queue) == Operations{{1, 1}});
  queue.push(cheap_offer(1, 2));
  CHECK(taken(queue) == Operations{{2, 1}});
  CHECK(taken(queue) == Operations{{1, 2}});
}

TEST_CASE("large edits of players wait for room, and their clients' edits wait behind them",
          "[world]") {
  EditQueue queue(16);
  queue.push(cheap_offer(1, 1));
  queue.push(costly_offer(1, 2));
  queue.push(cheap_offer(1, 3));
  queue.push(costly_offer(2, 1));
  EditOffer rollback = costly_offer(3, 1);
  rollback.cause = Cause::rollback;
  queue.push(rollback);
  CHECK(queue.has_ready(false));
  CHECK(taken(queue, 0) == Operations{{1, 1}});  // the next two do not fit one commit
  CHECK(taken(queue, 0) == Operations{{3, 1}});
  CHECK_FALSE(queue.has_ready(false));
  CHECK(taken(queue, 0).empty());
  queue.push(cheap_offer(4, 1));
  CHECK(queue.has_ready(false));
  CHECK(taken(queue, 0) == Operations{{4, 1}});
  CHECK(queue.size() == 3);
  CHECK(queue.has_ready(true));
  CHECK(queue.has({1, 1, 2}));
  CHECK(queue.has({1, 1, 3}));
  CHECK_FALSE(queue.has({1, 1, 1}));  // ordered
  CHECK_FALSE(queue.has({1, 2, 2}));  // another instance
  CHECK_FALSE(queue.has({1, 1, 4}));
  CHECK(taken(queue, 1) == Operations{{1, 2}});  // room for one
  CHECK_FALSE(queue.has({1, 1, 2}));
  CHECK(taken(queue, 0) == Operations{{1, 3}});
  CHECK(taken(queue, 1) == Operations{{2, 1}});
  CHECK_FALSE(queue.has_ready(true));
}

TEST_CASE("a commit has at most as many edits as its message", "[world]") {
  EditQueue queue(16);
  for (ClientSequence seq = 1; seq <= 2 * kCommitEditsMax; ++seq) queue.push(cheap_offer(1, seq));
  ClientSequence next = 1;
  while (queue.size() > 0) {
    const Operations batch = taken(queue);
    REQUIRE_FALSE(batch.empty());
    CHECK(batch.size() <= kCommitEditsMax);
    CHECK(batch.front().second == next);
    next += batch.size();
  }
  CHECK(next == 2 * kCommitEditsMax + 1);
}

TEST_CASE(
    "beyond a bound the queue has room for small edits and the first large edit of each player",
    "[world]") {
  EditQueue queue(16);
  const EditDescriptor large = costly_offer(1, 1).edit, small = cheap_offer(1, 1).edit;
  const std::size_t most = EditQueue::kWaitingWorkMax / edit_work(large, 16) + 1;
  for (ClientSequence seq = 1; seq <= most; ++seq) {
    REQUIRE(queue.has_room_for(large, 1));
    queue.push(costly_offer(1, seq));
  }
  CHECK_FALSE(queue.has_room_for(large, 1));
  CHECK(queue.has_room_for(small, 1));
  CHECK(taken(queue).front() == std::pair<AuthorId, ClientSequence>{1, 1});
  CHECK(queue.has_room_for(large, 1));
  queue.push(costly_offer(1, most + 1));
  const std::size_t all = EditQueue::kFirstWaitingWorkMax / edit_work(large, 16) + 1;
  for (auto author = static_cast<AuthorId>(2); queue.size() < all; ++author) {
    REQUIRE(queue.has_room_for(large, author));
    queue.push(costly_offer(author, 1));
    CHECK_FALSE(queue.has_room_for(large, author));
  }
  CHECK_FALSE(queue.has_room_for(large, 1'000'000));
  CHECK(queue.has_room_for(small, 1'000'000));
}

TEST_CASE("a queue knows whose edits wait", "[world]") {
  EditQueue queue(16);
  queue.push(costly_offer(5, 1));
  queue.push(cheap_offer(7, 1));
  for (const AuthorId author : {4U, 6U, 8U}) CHECK_FALSE(queue.has_of(author));
  for (const AuthorId author : {5U, 7U}) CHECK(queue.has_of(author));
  taken(queue, 0);
  CHECK(queue.has_of(5));
  CHECK_FALSE(queue.has_of(7));
}

}  // namespace runstone
