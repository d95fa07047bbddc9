#include "client/api/edit_outcomes.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test {
namespace {

using session_bench::SessionBench;

struct Outcomes {
  ClientSession session{SessionConfig{}};
  EditOutcomes edits;
  EventQueue events;

  std::vector<WorldEvent> take(const ReplicaChanges& changes) {
    edits.take(changes, session, events);
    return events.drain();
  }
  static EditChange change(ClientSequence seq, bool predicted = false) {
    EditChange out;
    out.op.seq = seq;
    out.seq = 40 + seq;
    out.is_local = true;
    out.predicted = predicted;
    return out;
  }
};

}  // namespace

TEST_CASE_METHOD(Outcomes, "an edit is confirmed once, although its chunks arrive in parts",
                 "[client_api]") {
  edits.add(1);
  ReplicaChanges changes;
  changes.edits = {change(1, true)};
  CHECK(take(changes).empty());
  changes.edits = {change(1), change(2)};  // the second one is not followed
  const auto first = take(changes);
  REQUIRE(first.size() == 1);
  CHECK(std::get<EditConfirmed>(first[0]).edit == 1);
  CHECK(std::get<EditConfirmed>(first[0]).sequence == 41);
  CHECK(take(changes).empty());
  CHECK(edits.count() == 1);
  changes = {};
  changes.durable = {1, 2};
  const auto last = take(changes);
  REQUIRE(last.size() == 1);
  CHECK(std::get<EditDurable>(last[0]).edit == 1);
  CHECK(edits.count() == 0);
}

TEST_CASE_METHOD(Outcomes, "an edit that is rejected after a confirmation is reported as rejected",
                 "[client_api]") {
  edits.add(1);
  edits.add(2);
  ReplicaChanges changes;
  changes.edits = {change(1)};
  changes.rejects = {{1, RejectReason::not_permitted, "not here"}, {2, RejectReason::busy, ""}};
  const auto out = take(changes);
  REQUIRE(out.size() == 3);
  CHECK(std::get<EditRejected>(out[1]).reason == "not_permitted");
  CHECK(std::get<EditRejected>(out[1]).text == "not here");
  CHECK_FALSE(std::get<EditRejected>(out[2]).text.empty());
  CHECK(edits.count() == 0);
}

TEST_CASE_METHOD(Outcomes, "an edit that waits to be offered again and is given up is rejected",
                 "[client_api]") {
  edits.add(1);
  ReplicaChanges changes;
  changes.rejects = {{1, RejectReason::busy, "full", true}};
  const auto out = take(changes);  // the session does not keep it
  REQUIRE(out.size() == 1);
  CHECK(std::get<EditRejected>(out[0]).edit == 1);
  CHECK(edits.count() == 0);
}

TEST_CASE_METHOD(SessionBench, "an edit that the session offers again keeps its number",
                 "[client_api]") {
  EditOutcomes edits;
  EventQueue events;
  const auto outcomes = [&] {
    edits.take(session.replica().drain_changes(), session, events);
    return events.drain();
  };
  const EditDescriptor edit{SetVoxel{{1, 2, 3}}, {}, 4};
  static_cast<void>(open());
  session.disconnected();
  now += 1'000;
  edits.add(session.offer(edit, now, now).value());
  now += 1'000;
  static_cast<void>(open());
  for (ClientSequence seq = 1; seq <= 2; ++seq) {
    pong();
    session.tick(now);
    receive(Reject{seq, RejectReason::busy, "", 0});
    CHECK(outcomes().empty());
    now += LostEdits::kAgainUs;
    pong();
    session.tick(now);
    CHECK(outcomes().empty());
    REQUIRE(session.replica().local_edits().find(seq + 1)->again_of == 1);
  }
  receive(server.world.commit(session.operation(3), edit));
  const auto out = outcomes();
  REQUIRE(out.size() == 1);
  CHECK(std::get<EditConfirmed>(out[0]).edit == 1);
  CHECK(edits.count() == 1);
}

TEST_CASE_METHOD(Outcomes, "another world ends all edits", "[client_api]") {
  edits.add(1);
  edits.add(2);
  ReplicaChanges changes;
  changes.unseen = {2};
  CHECK(std::holds_alternative<EditUnseen>(take(changes).at(0)));
  edits.world_changed(events);
  const auto out = events.drain();
  REQUIRE(out.size() == 1);
  CHECK(std::get<EditRejected>(out[0]).reason == "another_world");
}

TEST_CASE("a queue of events drops the oldest of a kind, but no outcome of an edit",
          "[client_api]") {
  EventQueue queue;
  queue.push(EditConfirmed{7, 7});
  for (Sequence seq = 1; seq <= EventQueue::kEventsMax + 5; ++seq)
    queue.push(OthersEdit{1, seq, {}});
  for (EditNumber edit = 1; edit <= EventQueue::kEventsMax + 5; ++edit)
    queue.push(EditDurable{edit});
  CHECK(queue.edit_events() == EventQueue::kEventsMax + 6);
  const auto out = queue.drain();
  CHECK(out.size() == 2 * EventQueue::kEventsMax + 6);
  CHECK(std::get<EditConfirmed>(out[0]).edit == 7);
  CHECK(std::get<OthersEdit>(out[1]).sequence == 6);
  CHECK(queue.drain().empty());
  CHECK(queue.edit_events() == 0);
}

}  // namespace runstone::test
