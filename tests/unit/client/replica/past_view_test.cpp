#include "client/replica/past_view.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

struct PastViewFixture {
  PastViewFixture() {
    current = table.track({0, {0, 0, 0}}).first;
    expected = table.track({0, {1, 0, 0}}).first;
    unavailable = table.track({0, {2, 0, 0}}).first;
    table.answer(*current);
    table.set_unavailable(*unavailable);
    for (TrackedChunk* chunk : {current, expected}) {
      chunk->add_pending(4, {SetVoxel{{1, 1, 1}}, {}, 2});
      chunk->inbox.push_back({});
      chunk->latest = 7;
      chunk->cached = Version{1, 2};
      chunk->behind_of = Version{1, 3};
    }
  }
  ReplicaChunks table;
  TrackedChunk *current, *expected, *unavailable;
  PastView view;
};

}  // namespace

TEST_CASE_METHOD(PastViewFixture,
                 "on the way into the past every chunk is expected and nothing is pending",
                 "[replica]") {
  CHECK_FALSE(view.is_past());
  view.show(PastMoment{5, 1000}, table);
  REQUIRE(view.is_past());
  CHECK(view.moment()->seq == 5);
  CHECK(view.moment()->utc_us == 1000);
  CHECK(table.count(ChunkState::expected) == 3);
  for (const auto& [key, chunk] : table) {
    CHECK(chunk.pending.empty());
    CHECK(chunk.inbox.empty());
    CHECK(chunk.latest == 0);
    CHECK_FALSE(chunk.cached.has_value());
    CHECK(chunk.behind_of == Version{});
  }
}

TEST_CASE_METHOD(PastViewFixture, "from moment to moment a current chunk stays current",
                 "[replica]") {
  view.show(PastMoment{5, 1000}, table);
  table.answer(*current);
  table.set_unavailable(*unavailable);
  view.show(PastMoment{3, 900}, table);
  CHECK(current->is_current());
  CHECK(expected->state() == ChunkState::expected);
  CHECK(unavailable->state() == ChunkState::expected);
}

TEST_CASE_METHOD(PastViewFixture,
                 "back in the live world every chunk is expected and keeps its inbox",
                 "[replica]") {
  view.show(PastMoment{5, 1000}, table);
  table.answer(*current);
  current->inbox.push_back({});
  current->latest = 9;
  view.show(std::nullopt, table);
  CHECK_FALSE(view.is_past());
  CHECK(table.count(ChunkState::expected) == 3);
  CHECK(current->inbox.size() == 1);
  CHECK(current->latest == 9);
}

TEST_CASE_METHOD(PastViewFixture, "a new connection shows the live world and changes no chunk",
                 "[replica]") {
  view.show(PastMoment{5, 1000}, table);
  table.answer(*current);
  view.reset();
  CHECK_FALSE(view.is_past());
  CHECK(current->is_current());
}
