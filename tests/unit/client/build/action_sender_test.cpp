#include "client/build/action_sender.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <utility>

#include "client/build/joined_source.hpp"
#include "common/core/hash.hpp"
#include "tests/unit/client/build/fake_port.hpp"

namespace runstone::test {
namespace {

using State = ActionSender::State;

}  // namespace

TEST_CASE("an action is sent behind its first edit, within the window, under one number",
          "[client][build]") {
  FakePort port;
  ActionSender sender(voxels_of(100));
  sender.step(port, 0);
  CHECK(port.offered.size() == 1);  // it names the action, so its answer comes first
  sender.step(port, 1);
  CHECK(port.offered.size() == 1);
  port.apply_all();
  sender.step(port, 2);
  CHECK(port.offered.size() == 1 + port.window);
  for (int i = 0; i < 20; ++i) {
    port.apply_all();
    sender.step(port, 3 + i);
  }
  CHECK(sender.state() == State::done);
  CHECK(port.applied.size() == 100);
  CHECK(port.actions() == std::set<ClientSequence>{11});
  CHECK(port.is_optional);
  CHECK(port.has_sender);
  CHECK(sender.progress().edits_done == 100);
  CHECK(sender.progress().percent() == 100);
}

TEST_CASE("a step offers a bounded number of edits", "[client][build]") {
  FakePort port;
  port.window = 1'000;
  ActionSender sender(voxels_of(100));
  sender.step(port, 0);
  port.apply_all();
  sender.step(port, 1, 5);
  CHECK(port.under_way() == 5);
}

TEST_CASE("an action waits for the connection, the budget and what its source lacks",
          "[client][build]") {
  FakePort port;
  std::vector<SourceStep> steps = {voxel_step(0), SourceStep::later("ground that is not here yet"),
                                   voxel_step(1)};
  ActionSender sender(std::make_unique<ListSource>(steps));
  port.closed = "the connection";
  sender.step(port, 0);
  CHECK(port.offered.empty());
  CHECK(sender.progress().waits_for == "the connection");
  port.closed.clear();
  port.wait = 1'000;
  sender.step(port, 1);
  CHECK(port.offered.empty());
  CHECK(sender.progress().waits_for == "your edit budget");
  port.wait = 0;
  sender.step(port, 2);
  port.apply_all();
  sender.step(port, 3);
  CHECK(sender.progress().waits_for == "ground that is not here yet");
  sender.step(port, 4);
  port.apply_all();
  sender.step(port, 5);
  CHECK(sender.state() == State::done);
  CHECK(sender.progress().waits_for.empty());
}

TEST_CASE("refused edits are skipped and counted", "[client][build]") {
  FakePort port;
  ActionSender sender(voxels_of(10));
  sender.step(port, 0);
  // The first one is refused: the next one begins the action.
  sender.rejected(port.reject(11, RejectReason::not_permitted, "the ground is protected: spawn"),
                  1);
  sender.step(port, 2);
  CHECK(port.offered.at(12).action == 12);
  port.apply(12);
  port.refusal = "you may not edit there";  // by the client itself
  sender.step(port, 3);
  port.apply_all();
  sender.step(port, 4);
  CHECK(sender.state() == State::done);
  CHECK(port.applied.size() == 8);
  CHECK(port.actions() == std::set<ClientSequence>{12});
  CHECK(sender.progress().edits_refused == 2);
  CHECK(sender.progress().voxels_refused == 2);
  CHECK(end_text_of("fill", sender.progress()) ==
        "fill: 8 voxels; left out 2 voxels in 2 parts: you may not edit there");
}

TEST_CASE("an action ends when too many edits in a row are refused", "[client][build]") {
  FakePort port;
  ActionSender sender(voxels_of(1'000));
  for (TimeUs now = 0; !sender.has_ended(); ++now) {
    REQUIRE(now < 1'000);
    sender.step(port, now);
    for (const auto& [seq, edit] : std::map(port.offered)) {
      if (!edit.is_answered) sender.rejected(port.reject(seq, RejectReason::outside_world), now);
    }
  }
  CHECK(sender.state() == State::stopped);
  CHECK(sender.progress().edits_refused == ActionSender::kRefusedInRowMax);
  CHECK(sender.progress().stop_reason == "the last 64 parts were refused: outside_world");
}

TEST_CASE("an edit that is refused for a while is offered again as a new one", "[client][build]") {
  FakePort port;
  ActionSender sender(voxels_of(3));
  sender.step(port, 0);
  port.apply(11);
  sender.step(port, 1);
  sender.rejected(port.reject(12, RejectReason::busy), 2);
  port.apply(13);
  sender.step(port, 3);
  CHECK(port.offered.size() == 3);
  CHECK(sender.progress().waits_for == "the server is busy");
  sender.step(port, 2 + ActionSender::kAgainUs);
  REQUIRE(port.offered.size() == 4);
  CHECK(port.offered.at(14).edit == port.offered.at(12).edit);
  CHECK(port.offered.at(14).action == 11);
  port.apply(14);
  sender.step(port, 3 + ActionSender::kAgainUs);
  CHECK(sender.state() == State::done);
  CHECK(sender.progress().edits_done == 3);
}

TEST_CASE("the rest of an action that the server does not know is another action",
          "[client][build]") {
  FakePort port;
  port.window = 2;
  ActionSender sender(voxels_of(6));
  sender.step(port, 0);
  port.apply(11);
  sender.step(port, 1);
  port.apply(12);
  sender.rejected(port.reject(13, RejectReason::unknown_action), 2);
  sender.step(port, 3);
  REQUIRE(port.offered.size() == 4);
  CHECK(port.offered.at(14).edit == port.offered.at(13).edit);
  CHECK(port.offered.at(14).action == 14);
  for (TimeUs now = 4; !sender.has_ended(); ++now) {
    REQUIRE(now < 100);
    port.apply_all();
    sender.step(port, now);
  }
  CHECK(port.applied.size() == 6);
  CHECK(port.actions() == std::set<ClientSequence>{11, 14});
}

TEST_CASE("without large actions, an action has 256 edits", "[client][build]") {
  FakePort port;
  port.edits_max = kActionEditsMax;
  ActionSender sender(voxels_of(600));
  for (TimeUs now = 0; !sender.has_ended(); ++now) {
    REQUIRE(now < 1'000);
    sender.step(port, now);
    port.apply_all();
  }
  CHECK(port.applied.size() == 600);
  std::map<ClientSequence, std::size_t> edits;
  for (const auto& [seq, edit] : port.offered) ++edits[edit.action];
  REQUIRE(edits.size() == 3);
  CHECK(edits.begin()->second == 256);
}

TEST_CASE("a cancelled action waits for what is under way, and offers an undo", "[client][build]") {
  FakePort port;
  ActionSender sender(voxels_of(100));
  sender.step(port, 0);
  port.apply_all();
  sender.step(port, 1);
  sender.cancel();
  sender.step(port, 2);
  CHECK(sender.state() == State::finishing);
  CHECK(port.offered.size() == 9);
  port.apply_all();
  sender.step(port, 3);
  CHECK(sender.state() == State::stopped);
  CHECK(end_text_of("fill", sender.progress()) ==
        "fill: 9 voxels; it ended early: you have stopped it; an undo takes back what was done");
}

TEST_CASE("an undo of the action stops it", "[client][build]") {
  FakePort port;
  ActionSender sender(voxels_of(100));
  sender.step(port, 0);
  port.apply_all();
  sender.step(port, 1);
  sender.rejected(port.reject(12, RejectReason::action_ended), 2);
  for (ClientSequence seq = 13; seq <= 19; ++seq)
    sender.rejected(port.reject(seq, RejectReason::action_ended), 2);
  sender.step(port, 3);
  CHECK(sender.state() == State::stopped);
  CHECK(sender.progress().stop_reason == "you have undone it");
}

TEST_CASE("what needs all parts before it is not sent if one of them is refused",
          "[client][build]") {
  FakePort port;
  auto joined = std::make_unique<JoinedSource>();
  joined->add(voxels_of(3));
  joined->add(voxels_of(2), PartOrder::after_all_before);
  ActionSender sender(std::move(joined));
  sender.step(port, 0);
  port.apply(11);
  sender.step(port, 1);
  CHECK(port.offered.size() == 3);
  port.apply(12);
  sender.step(port, 2);
  CHECK(port.offered.size() == 3);
  SECTION("all are applied") {
    port.apply(13);
    sender.step(port, 3);
    CHECK(port.offered.size() == 5);
  }
  SECTION("one is refused") {
    sender.rejected(port.reject(13, RejectReason::not_permitted, "the ground is protected: a"), 3);
    sender.step(port, 4);
    CHECK(port.offered.size() == 3);
    CHECK(sender.state() == State::stopped);
  }
}

TEST_CASE("every edit is applied once, whatever is refused for a while or lost",
          "[client][build][property]") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    SplitMix64 rng(seed);
    FakePort port;
    port.window = 1 + rng.below(20);
    const auto count = static_cast<std::int32_t>(1 + rng.below(200));
    ActionSender sender(voxels_of(count));
    TimeUs now = 0;
    for (int turn = 0; !sender.has_ended(); ++turn) {
      REQUIRE(turn < 20'000);
      now += 50'000;
      port.closed = rng.below(10) == 0 ? "the connection" : "";
      port.wait = rng.below(5) == 0 ? 1 : 0;
      for (const auto& [seq, edit] : std::map(port.offered)) {
        if (edit.is_answered || rng.below(2) == 0) continue;
        if (rng.below(8) == 0) {
          constexpr RejectReason kPassing[] = {RejectReason::busy, RejectReason::rate_limited,
                                               RejectReason::unknown_action};
          sender.rejected(port.reject(seq, kPassing[rng.below(3)]), now);
        } else {
          port.apply(seq);
        }
      }
      sender.step(port, now, 1 + rng.below(10));
    }
    CHECK(sender.state() == State::done);
    std::set<std::int32_t> voxels;
    for (const ClientSequence seq : port.applied)
      CHECK(voxels.insert(std::get<SetVoxel>(port.offered.at(seq).edit.shape).at.x).second);
    CHECK(voxels.size() == static_cast<std::size_t>(count));
    CHECK(sender.progress().voxels_done == static_cast<std::uint64_t>(count));
    CHECK(sender.progress().voxels_sent == static_cast<std::uint64_t>(count));
  }
}

}  // namespace runstone::test
