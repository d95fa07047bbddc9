#include "client/replica/local_edits.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

using Sequences = std::vector<ClientSequence>;

struct LocalEditsFixture {
  ClientSequence add() {
    const auto seq = edits.add({SetVoxel{{1, 2, 3}}, {}, 1}, {{0, {0, 0, 0}}}, 500);
    REQUIRE(seq.has_value());
    return *seq;
  }
  LocalEditState state(ClientSequence seq) const { return edits.find(seq)->state; }
  LocalEdits edits;
};

Reject resolved(ClientSequence seq, Sequence at) {
  return {seq, RejectReason::already_resolved, "", at};
}

}  // namespace

TEST_CASE_METHOD(LocalEditsFixture, "client sequences ascend from 1 without gaps", "[replica]") {
  CHECK(add() == 1);
  CHECK(add() == 2);
  CHECK(edits.find(1)->submitted_us == 500);
  CHECK(edits.find(1)->chunks.size() == 1);
  CHECK(edits.unanswered() == Sequences{1, 2});
  CHECK(edits.pending_count() == 2);
  CHECK(edits.counters().submitted == 2);
}

TEST_CASE_METHOD(LocalEditsFixture, "the memory of an edit counts until the edit leaves",
                 "[replica]") {
  CHECK(edits.bytes() == 0);
  const ClientSequence voxel = add();
  const std::size_t one = edits.bytes();
  CHECK(one > sizeof(LocalEdit));
  const EditDescriptor stroke{FillStroke{std::vector<VoxelPos>(200, VoxelPos{1, 2, 3}), 1}, {}, 1};
  const auto long_stroke = edits.add(stroke, {}, 0);
  REQUIRE(long_stroke.has_value());
  CHECK(edits.bytes() >= one + 200 * sizeof(VoxelPos));
  CHECK(edits.reject({*long_stroke, RejectReason::busy, "", 0}, {1, 0}).has_value());
  CHECK(edits.bytes() == one);
  edits.confirm(voxel, {1, 10});
  CHECK(edits.bytes() == one);
  CHECK(edits.retire(10).durable.size() == 1);
  CHECK(edits.bytes() == 0);
  add();
  edits.clear();
  CHECK(edits.bytes() == 0);
}

TEST_CASE_METHOD(LocalEditsFixture,
                 "an edit beyond the bound is refused and counts as not submitted", "[replica]") {
  for (std::size_t i = 0; i < kLocalEditsMax; ++i) add();
  const auto refused = edits.add({SetVoxel{{1, 2, 3}}, {}, 1}, {}, 0);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
  CHECK(edits.counters().submitted == kLocalEditsMax);
}

TEST_CASE_METHOD(LocalEditsFixture, "a confirmed edit is kept until its sequence is durable",
                 "[replica]") {
  const ClientSequence seq = add();
  CHECK(edits.confirm(seq, {1, 10}) == LocalEditState::pending);
  CHECK(state(seq) == LocalEditState::confirmed);
  CHECK(edits.unanswered().empty());
  CHECK(edits.retire(9).durable.empty());
  CHECK(edits.retire(10).durable == Sequences{seq});
  CHECK(edits.find(seq) == nullptr);
  CHECK_FALSE(edits.confirm(seq, {1, 10}).has_value());
  CHECK(edits.counters().confirmed == 1);
  CHECK(edits.counters().durable == 1);
}

TEST_CASE_METHOD(LocalEditsFixture, "a second commit of an edit is recognised and counts once",
                 "[replica]") {
  const ClientSequence seq = add();
  CHECK(edits.confirm(seq, {1, 10}) == LocalEditState::pending);
  CHECK(edits.confirm(seq, {1, 10}) == LocalEditState::confirmed);
  CHECK(edits.counters().confirmed == 1);
}

TEST_CASE_METHOD(LocalEditsFixture,
                 "a rejected edit leaves, and a confirmed one cannot be rejected", "[replica]") {
  const ClientSequence first = add(), second = add();
  edits.confirm(second, {1, 10});
  const auto rejection = edits.reject({first, RejectReason::rate_limited, "", 0}, {1, 10});
  REQUIRE(rejection.has_value());
  CHECK_FALSE(rejection->is_resolved);
  CHECK(rejection->edit.chunks.size() == 1);
  CHECK(edits.find(first) == nullptr);
  CHECK_FALSE(edits.reject({first, RejectReason::busy, "", 0}, {1, 10}).has_value());
  CHECK_FALSE(edits.reject({second, RejectReason::busy, "", 0}, {1, 10}).has_value());
  CHECK(state(second) == LocalEditState::confirmed);
  CHECK(edits.counters().rejected == 1);
}

TEST_CASE_METHOD(LocalEditsFixture,
                 "an edit that was resolved unseen is durable with the sequence it names",
                 "[replica]") {
  const ClientSequence named = add(), unnamed = add();
  const auto rejection = edits.reject(resolved(named, 4), {1, 10});
  REQUIRE(rejection.has_value());
  CHECK(rejection->is_resolved);
  CHECK(rejection->edit.state == LocalEditState::pending);
  CHECK(state(named) == LocalEditState::unseen);
  edits.reject(resolved(unnamed, 0), {1, 10});
  CHECK(edits.retire(4).unseen == Sequences{named});
  CHECK(edits.retire(9).unseen.empty());
  CHECK(edits.retire(10).unseen == Sequences{unnamed});
  CHECK(edits.counters().unseen == 2);
  CHECK(edits.counters().durable == 0);
}

TEST_CASE_METHOD(LocalEditsFixture,
                 "a new connection offers lost edits again and asks about missed answers",
                 "[replica]") {
  const ClientSequence confirmed = add(), missed = add(), lost = add(), open = add();
  edits.confirm(confirmed, {1, 10});
  edits.confirm(lost, {1, 11});
  edits.mark_sent(missed, 100);
  CHECK(edits.resume(missed) == Sequences{lost, open});
  CHECK(state(confirmed) == LocalEditState::confirmed);
  CHECK(state(missed) == LocalEditState::asking);
  CHECK(edits.find(missed)->sent_us == LocalEdit::kNever);
  CHECK(state(lost) == LocalEditState::pending);
  CHECK(edits.unanswered() == Sequences{missed, lost, open});
  CHECK(edits.pending_count() == 2);
  CHECK(edits.counters().offered_again == 2);
  // An edit that asks is not retired, whatever is durable.
  CHECK(edits.retire(100).durable == Sequences{confirmed});
  edits.reject(resolved(missed, 0), {2, 12});
  CHECK(edits.retire(100).unseen == Sequences{missed});
}

TEST_CASE_METHOD(LocalEditsFixture, "an unseen edit that the server lost is pending again",
                 "[replica]") {
  const ClientSequence seq = add();
  edits.reject(resolved(seq, 3), {1, 10});
  CHECK(edits.resume(0) == Sequences{seq});
  CHECK(state(seq) == LocalEditState::pending);
  CHECK(edits.find(seq)->version == Version{});
}

TEST_CASE_METHOD(LocalEditsFixture, "edits are overdue in the order in which they were sent",
                 "[replica]") {
  const ClientSequence first = add(), second = add(), third = add();
  edits.mark_sent(first, 100);
  edits.mark_sent(second, 200);
  edits.mark_sent(third, 300);
  CHECK(edits.overdue(99).empty());
  CHECK(edits.overdue(200) == Sequences{first, second});
  edits.confirm(first, {1, 1});
  CHECK(edits.overdue(300) == Sequences{second, third});
  const ClientSequence unsent = add();
  edits.mark_sent(second, 900);
  CHECK(edits.overdue(300).empty());
  CHECK(edits.unanswered() == Sequences{second, third, unsent});
}
