#include "server/world/people/waiting_edits.hpp"

#include <catch2/catch.hpp>

#include "protocol/limits.hpp"
#include "protocol/rules/window_bytes.hpp"
#include "tests/support/edits/edit_oracle.hpp"

namespace runstone::test {
namespace {

EditRequest waiting(ClientSequence seq, ClientSequence action) {
  return {seq, 0, {SetVoxel{{1, 2, 3}}, {}, 1}, std::nullopt, action};
}

}  // namespace

TEST_CASE("edits that wait keep their order, and are found by their number", "[world]") {
  WaitingEdits edits;
  CHECK_FALSE(edits.has_any());
  for (const ClientSequence seq : {3U, 4U, 9U}) edits.push(5, waiting(seq, 3));
  edits.push(6, waiting(4, 4));
  CHECK(edits.size() == 4);
  CHECK(edits.has(5, 4));
  CHECK_FALSE(edits.has(5, 5));
  CHECK_FALSE(edits.has(7, 4));
  CHECK(edits.front(5).client_seq == 3);
  edits.pop(5);
  CHECK(edits.front(5).client_seq == 4);
  CHECK_FALSE(edits.has(5, 3));
  edits.pop(5);
  edits.pop(5);
  CHECK_FALSE(edits.has_any(5));
  edits.forget(6);
  CHECK_FALSE(edits.has_any());
}

TEST_CASE("a session waits with a bounded number of edits and bytes", "[world]") {
  WaitingEdits edits;
  for (ClientSequence seq = 1; seq <= kWaitingEditsMax; ++seq) {
    REQUIRE(edits.has_room_for(1, waiting(seq, 1)));
    edits.push(1, waiting(seq, 1));
  }
  CHECK_FALSE(edits.has_room_for(1, waiting(500, 1)));
  CHECK_FALSE(edits.has_room_for(1, waiting(500, 0)));  // a click behind them counts as well
  CHECK(edits.has_room_for(2, waiting(500, 1)));        // of another session
  edits.pop(1);
  CHECK(edits.has_room_for(1, waiting(900, 1)));

  SplitMix64 rng(1);
  EditRequest paste = waiting(1, 1);
  paste.edit = {Paste{{0, 0, 0}, random_clipboard(rng, 40, 5), {}}, {}, kEmpty};
  std::size_t bytes = 0;
  for (ClientSequence seq = 1; edits.has_room_for(3, paste); ++seq) {
    REQUIRE(seq <= kWaitingEditsMax);
    edits.push(3, paste);
    bytes += window_bytes(paste.edit);
  }
  CHECK(bytes <= kWaitingEditBytesMax);
}

TEST_CASE("the sessions with waiting edits take turns", "[world]") {
  WaitingEdits edits;
  for (const SessionId session : {2U, 4U, 6U}) edits.push(session, waiting(1, 1));
  CHECK(edits.sessions() == std::vector<SessionId>{2, 4, 6});
  edits.begin_turn_at(4);
  CHECK(edits.sessions() == std::vector<SessionId>{4, 6, 2});
  edits.begin_turn_at(5);
  CHECK(edits.sessions() == std::vector<SessionId>{6, 2, 4});
  edits.begin_turn_at(7);
  CHECK(edits.sessions() == std::vector<SessionId>{2, 4, 6});
}

}  // namespace runstone::test
