// What a player may use, by the settings and by the player's role.
#include "server/world/rights/quotas.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

constexpr AddressBlock kHomeAddress = address_block_v4(1), kOtherAddress = address_block_v4(2);

Role builder_with(const char* name) {
  Role role = built_in_roles()[2];
  REQUIRE(role.rights.has(Right::build));
  role.name = name;
  return role;
}

struct QuotaBench : WorldBench {
  using WorldBench::WorldBench;

  void change(const RightsChange& change) {
    const auto done = server.changes().change_rights(change, RightsActor{}, 0, now());
    INFO((done ? std::string() : done.error()));
    REQUIRE(done.has_value());
  }
  void give(std::uint8_t who, const Role& role) {
    change(DefineRole{role});
    change(GrantRole{key_pair_of(seed_of(who)).public_key, role.name});
  }
  Welcome welcome(SessionId session) const {
    const auto sent = environment.messages<Welcome>(session, kEdge);
    REQUIRE(sent.size() == 1);
    return sent[0];
  }
  /// Returns how many of these edits were refused because a budget is used up.
  std::size_t refused(SessionId session, ClientSequence first, std::size_t count) {
    const std::size_t before = environment.messages<Reject>(session, kEdge).size();
    for (std::size_t i = 0; i < count; ++i) edit(session, first + i, kAtOrigin);
    const auto rejects = environment.messages<Reject>(session, kEdge);
    for (std::size_t i = before; i < rejects.size(); ++i)
      CHECK(rejects[i].reason == RejectReason::rate_limited);
    return rejects.size() - before;
  }
};

}  // namespace

TEST_CASE("a role may have an edit budget of its own, which the player is told",
          "[world][quotas]") {
  WorldConfig c = config();
  c.edit_budget = {1, 2};
  QuotaBench bench(c);
  bench.join(1, 1);
  CHECK(bench.refused(1, 1, 3) == 1);
  Role mason = builder_with("mason");
  mason.edit_budget = {1, 5};
  bench.give(1, mason);
  CHECK(bench.refused(1, 10, 6) == 1);
  bench.join(2, 2);
  CHECK(bench.refused(2, 1, 3) == 1);  // others are as before
  bench.server.disconnected(1);
  bench.join(3, 1, 2);
  CHECK(bench.welcome(3).edit_budget == mason.edit_budget);
  CHECK(bench.welcome(2).edit_budget == c.edit_budget);
  CHECK(bench.refused(3, 1, 1) == 1);  // a reconnection fills nothing
}

TEST_CASE("a role may see less far than the settings allow, and never farther", "[world][quotas]") {
  QuotaBench bench;
  Role near = builder_with("near");
  near.view_radius_max = 1;
  Role far = builder_with("far");
  far.view_radius_max = 200;
  bench.give(1, near);
  bench.give(2, far);
  bench.join(1, 1);
  bench.join(2, 2);
  CHECK(bench.welcome(1).view_radius_max == 1);
  CHECK(bench.welcome(2).view_radius_max == config().view_radius_max);
  CHECK(bench.welcome(2).tile_levels_max == config().tile_levels_max);
  bench.view(1, View{1, {0, 0, 0}, 4, 0});
  CHECK(bench.environment.snapshots.size() == 5);
}

TEST_CASE("a player's view loads chunks as fast as the player's budget allows", "[world][quotas]") {
  WorldConfig c = config();
  c.chunk_loads = {10, 3};
  QuotaBench bench(c);
  Role scout = builder_with("scout");
  scout.chunk_loads_per_second = 1'000;
  bench.give(3, scout);
  for (const std::uint8_t who : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}})
    bench.join(who, who);
  bench.view(1, kSmall);
  CHECK(bench.environment.snapshots.size() == 3);
  bench.view(2, kSmall);  // another player pays for the rest, and both get it
  CHECK(bench.environment.snapshots.size() == 5 + 5);
  bench.view(3, View{1, {100, 0, 0}, 1, 0});
  CHECK(bench.environment.snapshots.size() == 5 + 5 + 5);
  bench.tick(60'000);
  bench.view(2, View{1, {200, 0, 0}, 1, 0});
  CHECK(bench.environment.snapshots.size() == 5 + 5 + 5 + 1);
  for (int i = 0; i < 10; ++i) {
    bench.tick(100'000);
    bench.answer_loads();
  }
  // The view is complete in the end.
  CHECK(bench.environment.snapshots.size() == 5 + 5 + 5 + 5);
}

TEST_CASE("the players of one address load chunks together", "[world][quotas]") {
  WorldConfig c = config();
  c.chunk_loads = {10, 6};
  c.budgets_per_address = 1;
  QuotaBench bench(c);
  bench.join(1, 1, 1, kHomeAddress);
  bench.join(2, 2, 1, kHomeAddress);
  bench.join(3, 3, 1, kOtherAddress);
  bench.view(1, kSmall);
  CHECK(bench.environment.snapshots.size() == 5);
  bench.view(2, View{1, {100, 0, 0}, 1, 0});
  CHECK(bench.environment.snapshots.size() == 6);
  bench.view(3, View{1, {200, 0, 0}, 1, 0});
  CHECK(bench.environment.snapshots.size() == 6 + 5);
}

TEST_CASE("chunks of the past are paid too", "[world][quotas]") {
  WorldConfig c = config();
  c.chunk_loads = {10, 7};
  QuotaBench bench(c);
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.edit(1, 1, kAtOrigin);
  bench.server.commit(bench.now());
  bench.server.received(1, HistoryRequest{1, HistoryTarget::sequence, 1, 0}, bench.now());
  REQUIRE(bench.environment.history_requests.size() == 1);
  bench.server.ground().history_opened(1, 1, OpenedHistory{1, 0}, bench.now());
  CHECK(bench.environment.history_loads.size() == 2);
  for (int i = 0; i < 5; ++i) bench.tick(100'000);
  CHECK(bench.environment.history_loads.size() == 5);
}

}  // namespace runstone::test
