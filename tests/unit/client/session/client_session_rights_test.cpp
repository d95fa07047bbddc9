// What a session does with permissions and protected ground.
#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test {

using namespace session_bench;

namespace {

const Permissions kMayBuild{"builder", 2, 0, ""};
GroundBox spawn_box(Sequence seq, bool admits = false) {
  return {seq, {{0, 0, 0}, {8, 8, 8}}, 0, admits, "spawn", "ann"};
}

struct RightsSession : SessionBench {
  /// Opens a session with the feature, in which `early` overtakes SessionAccepted.
  void open_with(const std::vector<Message>& early, std::uint64_t features = kFeatureRights) {
    greet();
    CHECK((server.hello.features & kFeatureRights) != 0);
    Welcome welcome = server.make_welcome();
    welcome.features = features;
    welcome.signature =
        sign(server.keys_of_server, server_transcript(server.hello, welcome, std::nullopt));
    receive(welcome);
    for (const Message& message : early) receive(message);
    receive(SessionAccepted{6, 0});
    static_cast<void>(sent());
  }
  std::string refusal(const EditDescriptor& edit) {
    const auto seq = session.offer(edit, now, now);
    return seq ? "" : session.refusal_text(edit, seq.error());
  }
};

}  // namespace

TEST_CASE_METHOD(RightsSession, "an edit on protected ground is refused by the name of the box",
                 "[session][rights]") {
  open_with({kMayBuild});
  REQUIRE(session.is_open());
  CHECK(session.replica().ground().permissions() == kMayBuild);
  CHECK(refusal(set({1, 1, 1}, 1)).empty());
  receive(ProtectedGround{{}, {spawn_box(4)}});
  CHECK(refusal(set({1, 1, 1}, 1)) == "the ground is protected: spawn");
  CHECK(refusal(set({1, 1, 1}, 9999)) ==
        "the edit uses material 9999, and the world has those below 35");
  CHECK(refusal(set({8, 1, 1}, 1)).empty());
  receive(ProtectedGround{{4}, {spawn_box(5, true)}});
  CHECK(refusal(set({1, 1, 1}, 1)).empty());
  pong();
  session.tick(now);
  CHECK(take<EditRequest>(sent()).size() == 3);  // the refused ones were not sent
}

TEST_CASE_METHOD(RightsSession, "the edit budget follows the player's role", "[session][rights]") {
  Permissions poor = kMayBuild;
  poor.edit_budget = {1, 2};
  open_with({poor});
  CHECK(refusal(set({1, 1, 1}, 1)).empty());
  CHECK(refusal(set({1, 1, 1}, 2)).empty());
  CHECK(refusal(set({1, 1, 1}, 1)) == "your edit budget is used up for now");
  receive(poor);  // nothing has changed, so nothing is filled
  CHECK(refusal(set({1, 1, 1}, 1)) == "your edit budget is used up for now");
  receive(kMayBuild);
  CHECK(refusal(set({1, 1, 1}, 1)).empty());
}

TEST_CASE_METHOD(RightsSession, "another connection begins without boxes", "[session][rights]") {
  open_with({kMayBuild});
  receive(ProtectedGround{{}, {spawn_box(4)}});
  session.disconnected();
  CHECK(session.replica().ground().boxes().size() == 1);
  open_with({});
  CHECK(session.replica().ground().boxes().empty());
  CHECK_FALSE(session.replica().ground().permissions().has_value());
}

TEST_CASE_METHOD(RightsSession, "without the feature, and with too many boxes, the session ends",
                 "[session][rights]") {
  SECTION("the feature is not in force") {
    open_with({}, 0);
    receive(kMayBuild);
    REQUIRE(session.end().has_value());
    CHECK(session.end()->reason == GoodbyeReason::unexpected_message);
  }
  SECTION("one box more than a session knows") {
    open_with({});
    ProtectedGround most;
    for (Sequence seq = 1; seq <= kGroundBoxesMax; ++seq) most.boxes.push_back(spawn_box(seq));
    receive(most);
    CHECK_FALSE(session.end().has_value());
    receive(ProtectedGround{{}, {spawn_box(kGroundBoxesMax + 1)}});
    REQUIRE(session.end().has_value());
    CHECK(session.end()->reason == GoodbyeReason::malformed_message);
  }
}

}  // namespace runstone::test
