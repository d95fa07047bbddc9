// The commands `servers`, `handover` and `names release`.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "server/admin/command_table.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

/// A world with a player, whose program hands it over as the test says.
struct HandoverBench : CommandBench {
  explicit HandoverBench(bool can_hand_over)
      : services{bench.server,
                 service,
                 *this,
                 placing,
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

TEST_CASE("status says what to do about damaged rows", "[admin]") {
  CommandBench bench;
  std::uint64_t faults = 0;
  OperatorActions actions;
  actions.row_faults = [&] { return faults; };
  CommandServices services{bench.bench.server,
                           bench.service,
                           bench,
                           bench.placing,
                           bench.folder.path(),
                           actions,
                           [](const PublicKey&) { return false; }};
  const auto status = [&] {
    bench.answers.clear();
    give_command({services, {}, bench.bench.now(), bench.reply()}, "status");
    REQUIRE_FALSE(bench.answers.empty());
    return bench.answers.back().text;
  };
  CHECK(status().find("DAMAGE") == std::string::npos);
  faults = 3;
  CHECK_THAT(status(), Catch::Matchers::Contains("\nDAMAGE: 3 rows") &&
                           Catch::Matchers::Contains("runstone-server repair --world W --to NEW"));
}

/// A world in which somebody owns the name "Ana".
struct NameBench : CommandBench {
  NameBench()
      : CommandBench(config(), start_with_name()), services{bench.server,
                                                            service,
                                                            *this,
                                                            placing,
                                                            folder.path(),
                                                            {},
                                                            [](const PublicKey&) {
                   return false; }} {}
  void release() { give_command({services, {}, bench.now(), reply()}, "names release ana"); }
  /// Lets commands go on at a time after now.
  void tick_later(TimeUs later_us) {
    services.tick({bench.now().steady_us + later_us, bench.now().utc_us});
  }
  CommandServices services;

 private:
  static WorldStart start_with_name() {
    WorldStart start;
    start.name_claims.push_back({"ana", "Ana", PublicKey{7}});
    return start;
  }
};

TEST_CASE("a name is released at once, and the answer comes when that is on disk",
          "[admin][names]") {
  NameBench bench;
  bench.release();
  CHECK(bench.bench.server.order().names().size() == 0);
  REQUIRE(bench.bench.environment.names.size() == 1);
  bench.tick_later(0);
  CHECK(bench.answers.empty());
  SECTION("on disk in time") {
    bench.bench.server.names_durable(1, bench.bench.now());
    bench.tick_later(0);
    REQUIRE(bench.answers.size() == 1);
    CHECK(bench.answer().is_ok);
    CHECK(bench.answer().text.starts_with("\"Ana\" was owned by "));
  }
  SECTION("late") {
    bench.tick_later(kAnswerUnsavedUs);
    REQUIRE(bench.answers.size() == 1);
    CHECK(bench.answers[0].is_unsaved);
    bench.bench.server.names_durable(1, bench.bench.now());
    bench.tick_later(kAnswerUnsavedUs);
    REQUIRE(bench.answers.size() == 2);
    CHECK(bench.answer().is_ok);
  }
  SECTION("never") {
    bench.bench.server.log_failed();
    bench.tick_later(0);
    REQUIRE(bench.answers.size() == 1);
    CHECK_FALSE(bench.answer().is_ok);
    CHECK(bench.answer().text.find("NOT on disk") != std::string::npos);
  }
}

}  // namespace
}  // namespace runstone::test
