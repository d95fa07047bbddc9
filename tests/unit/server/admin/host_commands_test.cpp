// The commands `servers` and `handover`.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "server/admin/command_table.hpp"
#include "tests/unit/server/rollback/rollback_bench.hpp"

namespace runstone::test {
namespace {

/// A world with a player, whose program hands it over as the test says.
struct HandoverBench : RollbackBench {
  explicit HandoverBench(bool can_hand_over)
      : services{bench.server,
                 service,
                 *this,
                 folder.path(),
                 actions_of(can_hand_over),
                 [](const PublicKey&) { return false; }} {
    join(kBuilder);
  }
  /// Connects a server that follows.
  void connect_follower(SessionId link) {
    WorldServer& world = bench.server;
    Hello hello = bench.hello(200);
    hello.features = kFeatureServers;
    world.connected(link, bench.now());
    world.received(link, hello, bench.now());
    const auto welcome = bench.environment.messages<Welcome>(link, 0);
    REQUIRE(welcome.size() == 1);
    world.received(link, bench.client_auth(200, hello, welcome[0]), bench.now());
    world.received(link, FollowRequest{}, bench.now());
  }
  CommandAnswer give(const std::string& line) {
    answers.clear();
    give_command({services, {}, bench.now(), reply()}, line);
    REQUIRE_FALSE(answers.empty());
    return answers.back();
  }

  std::vector<std::optional<SessionId>> handed_over;
  CommandServices services;

 private:
  OperatorActions actions_of(bool can_hand_over) {
    OperatorActions actions;
    if (!can_hand_over) return actions;
    actions.hand_over = [this](std::optional<SessionId> successor, const CommandReply& answer) {
      handed_over.push_back(successor);
      answer(CommandAnswer::last("another server owns the world"));
    };
    return actions;
  }
};

TEST_CASE("the program hands the world over to the server that the command names",
          "[admin][servers]") {
  HandoverBench bench(true);
  CHECK(bench.give("handover").text == "handover: no other server follows this one");
  bench.connect_follower(17);
  CHECK(bench.give("servers").text ==
        "this server, the owner: 1 session, 0 edits since it owns the world\n"
        "server 17: 0 sessions, 0 edits since it connected");
  CHECK(bench.give("handover 18").text ==
        "handover: no server 18 follows this one (servers lists them)");
  CHECK(bench.handed_over.empty());
  const CommandAnswer done = bench.give("handover 17");
  CHECK(done.is_ok);
  CHECK(done.is_done);
  REQUIRE(bench.answers.size() == 2);
  CHECK_FALSE(bench.answers[0].is_done);
  CHECK(bench.give("handover").is_ok);
  CHECK(bench.handed_over == std::vector<std::optional<SessionId>>{17, std::nullopt});
}

TEST_CASE("a program that cannot hand a world over says so", "[admin][servers]") {
  HandoverBench bench(false);
  bench.connect_follower(17);
  const CommandAnswer refused = bench.give("handover");
  CHECK_FALSE(refused.is_ok);
  CHECK(refused.text == "this server cannot do that");
}

}  // namespace
}  // namespace runstone::test
