#include "client/api/event_queue.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace runstone::test {
namespace {

OthersEdit edit_of(Sequence sequence, std::size_t chunks) {
  return {1, sequence, std::vector<ChunkCoord>(chunks)};
}

}  // namespace

TEST_CASE("a full queue drops the oldest event of the same kind", "[client_api]") {
  EventQueue events;
  events.push(ChunkMissing{{7, 0, 0}});
  for (std::size_t i = 0; i <= EventQueue::kEventsMax; ++i) {
    events.push(ChatReceived{ChatReceived::From::player, "", std::to_string(i)});
    events.push(ChunkRemoved{});
    events.push(EditDurable{i});
  }
  CHECK(events.edit_events() == EventQueue::kEventsMax + 1);
  const std::vector<WorldEvent> drained = events.drain();
  CHECK(drained.size() == 1 + 3 * (EventQueue::kEventsMax + 1) - 1);
  CHECK(std::holds_alternative<ChunkMissing>(drained[0]));
  CHECK(std::holds_alternative<ChunkRemoved>(drained[1]));  // the line before it was dropped
  CHECK(events.edit_events() == 0);
  CHECK(events.drain().empty());
}

TEST_CASE("edits of others that name many chunks do not fill the memory", "[client_api]") {
  EventQueue events;
  events.push(edit_of(1, 10));
  events.push(EditDurable{1});
  events.push(edit_of(2, EventQueue::kNamedChunksMax - 10));
  events.push(edit_of(3, 10));  // the first one has to go
  std::vector<WorldEvent> drained = events.drain();
  REQUIRE(drained.size() == 3);
  CHECK(std::holds_alternative<EditDurable>(drained[0]));
  CHECK(std::get<OthersEdit>(drained[1]).sequence == 2);
  CHECK(std::get<OthersEdit>(drained[2]).sequence == 3);

  // An event that names more chunks than the bound stays alone, until the next one comes.
  events.push(edit_of(4, EventQueue::kNamedChunksMax));
  events.push(edit_of(5, EventQueue::kNamedChunksMax + 1));
  events.push(edit_of(6, 0));
  drained = events.drain();
  REQUIRE(drained.size() == 2);
  CHECK(std::get<OthersEdit>(drained[0]).sequence == 5);
  events.push(edit_of(7, EventQueue::kNamedChunksMax + 1));
  events.push(edit_of(8, 1));
  drained = events.drain();
  REQUIRE(drained.size() == 1);
  CHECK(std::get<OthersEdit>(drained[0]).sequence == 8);
}

}  // namespace runstone::test
