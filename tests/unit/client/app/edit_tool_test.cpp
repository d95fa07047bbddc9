#include "client/app/edit_tool.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "tests/support/authority_model.hpp"
#include "tests/support/chunks_message.hpp"
#include "tests/support/test_keys.hpp"

using namespace runstone;
using runstone::test::keys;

namespace {

constexpr TimeUs kNow = 1'000'000;
constexpr EditPath kPaths[] = {EditPath::local_predicted, EditPath::local_confirmed};

SessionConfig config() {
  SessionConfig out;
  out.keys = keys(1);
  out.instance = 42;
  out.view = {1, {0, 0, 0}, 1, 1};
  return out;
}

template <class T>
T sent(ClientSession& session) {
  for (const Message& message : session.take_outgoing()) {
    if (const auto* wanted = std::get_if<T>(&message)) return *wanted;
  }
  FAIL("the session did not send the expected message");
  return {};
}

/// A session in an open world whose server answers no edit.
struct Fixture {
  Fixture() {
    session.connected({5}, std::nullopt, kNow);
    const Hello hello = sent<Hello>(session);
    const KeyPair server = keys(9);
    Welcome welcome;
    welcome.world_id = {1, 2, 3};
    welcome.chunk_edge = 16;
    welcome.materials = default_material_table();
    welcome.server_key = server.public_key;
    welcome.challenge = {7};
    welcome.view_radius_max = 8;
    welcome.edit_volume_max = 1000;
    welcome.signature = sign(server, server_transcript(hello, welcome, std::nullopt));
    receive(welcome);
    receive(SessionAccepted{6, 0});
    REQUIRE(session.is_open());
  }
  void receive(Message message) { session.receive(std::move(message), {kNow, kNow, kNow}); }
  Result<void, std::string> submit(VoxelPos at) {
    return tool.submit({SetVoxel{at}, {}, 1}, kNow, kNow);
  }
  std::uint64_t infinite(EditPath path) const {
    return recorder.report()[path]
        .since_submit[static_cast<std::size_t>(LatencyStage::applied)]
        .infinite();
  }

  ClientSession session{config()};
  Player player;
  LatencyRecorder recorder;
  EditTool tool{session, player, recorder};
};

}  // namespace

TEST_CASE_METHOD(Fixture, "an edit in the live world is submitted and counted until it is answered",
                 "[client_app]") {
  REQUIRE(submit({1, 2, 3}).has_value());
  CHECK(tool.refused() == 0);
  CHECK(session.replica().local_edits().all().size() == 1);
  recorder.take(session.replica().drain_changes(), session.clock(), kNow);
  CHECK(infinite(EditPath::local_confirmed) == 1);
}

TEST_CASE_METHOD(Fixture, "an edit in the past is refused with a reason and is in no percentile",
                 "[client_app]") {
  REQUIRE(session.request_history({}).has_value());
  ViewState past;
  past.past = true;
  receive(past);
  REQUIRE(session.replica().past());
  const auto refused = submit({1, 2, 3});
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error() == "the past cannot be edited");
  CHECK(tool.refused() == 1);
  for (const EditPath path : kPaths) {
    CHECK(recorder.report()[path].edits == 0);
    CHECK(infinite(path) == 0);
  }
}

TEST_CASE_METHOD(Fixture, "an edit that finds no room is infinitely late", "[client_app]") {
  for (std::size_t i = 0; i < kLocalEditsMax; ++i)
    REQUIRE(session.submit({SetVoxel{{1, 2, 3}}, {}, 1}, kNow, kNow).has_value());
  REQUIRE_FALSE(submit({1, 2, 3}).has_value());
  CHECK(tool.refused() == 0);
  for (const EditPath path : kPaths) CHECK(infinite(path) == 1);
}

TEST_CASE_METHOD(Fixture, "a click at nothing makes no edit", "[client_app]") {
  CHECK(tool.remove(kNow).error() == "nothing is in reach");
  CHECK(tool.place(kNow).error() == "nothing is in reach");
  CHECK(tool.refused() == 0);
  CHECK(session.replica().local_edits().all().empty());
}

TEST_CASE_METHOD(Fixture, "a voxel is placed on the ground in sight, but not where the player is",
                 "[client_app]") {
  runstone::test::AuthorityModel world(16);  // solid below 0
  for (const std::int32_t y : {-1, 0})
    receive(runstone::test::chunks_of(world.snapshot({0, y, 0})));
  player.look(0, -std::numbers::pi / 2);
  for (const double inside : {0.5, -0.5}) {
    player.move_to({0.5, inside, 0.5});
    CHECK(tool.place(kNow).error() == "you stand there: step back first");
  }
  CHECK(session.replica().local_edits().all().empty());
  player.move_to({0.5, 1.5, 0.5});
  REQUIRE(tool.place(kNow).has_value());
  REQUIRE(session.replica().local_edits().all().size() == 1);
}
