// Owners of protected ground take edits of others back there.
#include <catch2/catch.hpp>
#include <string>

#include "server/admin/command_table.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

constexpr VoxelBox kDug{{0, 0, 0}, {8, 1, 1}}, kHome{{0, 0, 0}, {4, 4, 4}};

/// The griefer has built in and beside a box that becomes the builder's home.
struct OwnGroundBench : CommandBench {
  OwnGroundBench()
      : services{bench.server,
                 service,
                 *this,
                 placing,
                 folder.path(),
                 {},
                 [](const PublicKey&) {
              return false; }} {
    join(kGriefer);
    join(kBuilder);
    fill(kGriefer, kDug, 3);
    set(kBuilder, {1, 3, 1}, 2);
    protect("home", kHome, kBuilder);
    protect("away", {{20, 0, 0}, {24, 4, 4}}, kGriefer);
    run_all();
  }
  static PublicKey key_of(SessionId who) {
    return key_pair_of(seed_of(static_cast<std::uint8_t>(who))).public_key;
  }
  void protect(const std::string& name, const VoxelBox& place, SessionId owner) {
    ProtectedBox box;
    box.name = name;
    box.box = place;
    box.owner = key_of(owner);
    REQUIRE(bench.server.changes().change_rights(Protect{box}, {}, 0, bench.now()));
  }
  CommandAnswer player(SessionId who, const std::string& line) {
    answers.clear();
    const auto author = static_cast<AuthorId>(who);
    give_command({services, {author, {key_of(who), false}}, bench.now(), reply()}, line);
    for (int i = 0; i < 3; ++i) {
      run_all();
      services.tick(bench.now());
    }
    return answer();
  }

  CommandServices services;
};

}  // namespace

TEST_CASE("the owner of ground takes edits of others back there, and nothing beside it",
          "[admin][rollback][rights]") {
  OwnGroundBench bench;
  const CommandAnswer preview = bench.player(kBuilder, "rollback preview author player1");
  INFO(preview.text);
  REQUIRE(preview.is_ok);
  CHECK(contains(preview.text, "4 voxels"));
  CHECK(contains(bench.player(kBuilder, "rollback list").text, "p1 preview"));
  CHECK_FALSE(contains(bench.player(kGriefer, "rollback list").text, "p1"));
  CHECK_FALSE(bench.player(kGriefer, "rollback apply p1").is_ok);
  CHECK_FALSE(bench.player(kGriefer, "rollback cancel p1").is_ok);

  const CommandAnswer applied = bench.player(kBuilder, "rollback apply p1");
  INFO(applied.text);
  REQUIRE(applied.is_ok);
  CHECK(bench.at({3, 0, 0}) == kEmpty);
  CHECK(bench.at({4, 0, 0}) == 3);
  CHECK(bench.at({1, 3, 1}) == 2);
  const EditRecord& newest = bench.bench.environment.records.back();
  CHECK(newest.cause == Cause::rollback);
  CHECK(newest.op.author == kBuilder);

  const std::string id = std::to_string(newest.version.seq);
  CHECK(contains(bench.player(kBuilder, "rollback list").text, "rollback " + id + " "));
  CHECK_FALSE(contains(bench.player(kGriefer, "rollback list").text, "rollback " + id));
  CHECK(contains(bench.player(kGriefer, "rollback undo " + id).text, "is not one of yours"));
  // If two undos are given at once, the second one is refused.
  bench.answers.clear();
  for (int i = 0; i < 2; ++i) {
    const CommandCaller caller{kBuilder, {OwnGroundBench::key_of(kBuilder), false}};
    give_command({bench.services, caller, bench.bench.now(), bench.reply()}, "rollback undo " + id);
  }
  REQUIRE(bench.work());
  REQUIRE(bench.work());
  CHECK(bench.answer().text == "rollback undo: one of yours is still under way");
  bench.run_all();
  CHECK(bench.answer().is_ok);
  CHECK(bench.at({3, 0, 0}) == 3);
}

TEST_CASE("an owner is refused with words where the ground is not the owner's",
          "[admin][rollback][rights]") {
  OwnGroundBench bench;
  const auto refused = [&](const std::string& line) {
    const CommandAnswer answer = bench.player(kBuilder, line);
    CHECK_FALSE(answer.is_ok);
    return answer.text;
  };
  const std::string outside =
      "rollback preview: that is not wholly in ground of yours: your boxes are home";
  CHECK(refused("rollback preview author player1 in away") == outside);
  CHECK(refused("rollback preview author player1 box 0 0 0 4 0 0") == outside);
  CHECK(bench.player(kBuilder, "rollback preview author player1 box 0 0 0 3 0 0").is_ok);
  CHECK(contains(refused("rollback preview address-of player1"), "needs the right roll_back"));
  CHECK(contains(refused("rollback preview author player1 picture"), "needs the right roll_back"));
  CHECK(contains(refused("rollback preview in home box 0 0 0 1 1 1"), "not both"));

  bench.protect("yard", {{8, 0, 0}, {9, 1, 1}}, kBuilder);
  CHECK(refused("rollback preview author player1") ==
        "rollback preview: say in which of your boxes, with in NAME: home, yard");
  CHECK(bench.player(kBuilder, "rollback preview author player1 in home").is_ok);
  // One preview of an owner is kept.
  CHECK(contains(refused("rollback apply p1"), "there is no preview"));

  const Restrict freeze{RestrictionKind::freeze, OwnGroundBench::key_of(kBuilder), 0, ""};
  REQUIRE(bench.bench.server.changes().change_rights(freeze, {}, 0, bench.bench.now()));
  CHECK_FALSE(bench.player(kBuilder, "rollback apply p2").is_ok);
  REQUIRE(bench.bench.server.changes().change_rights(
      Lift{RestrictionKind::freeze, OwnGroundBench::key_of(kBuilder)}, {}, 0, bench.bench.now()));
  bench.protect("home", kHome, kGriefer);
  CHECK(contains(refused("rollback apply p2"), "is not wholly yours any more"));
  CHECK(bench.at({3, 0, 0}) == 3);
}

TEST_CASE("a player without ground and without the right takes back nothing",
          "[admin][rollback][rights]") {
  OwnGroundBench bench;
  REQUIRE(bench.bench.server.changes().change_rights(Unprotect{"home"}, {}, 0, bench.bench.now()));
  const CommandAnswer answer = bench.player(kBuilder, "rollback preview author player1");
  CHECK_FALSE(answer.is_ok);
  CHECK(answer.text.starts_with("this command needs the right roll_back; your role is builder"));
}

}  // namespace runstone::test
