// The names that keys own: written, read again, damaged, lost, and made from a world of format 2.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "common/names/folded_name.hpp"
#include "server/store/store.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

NameClaim claim_of(const std::string& name, AuthorId author) {
  return {folded_name(name), name, sample_player(author).key};
}

std::unique_ptr<Store> claimed_world(const std::string& place, StoreAccess access) {
  auto store = open_world(place, access);
  if (!store) FAIL(store.error().message());
  return *std::move(store);
}

/// Makes a closed world with two claims.
void make_claims(const std::string& place) {
  const auto store = *create_world(place, sample_meta());
  const std::vector<NameChange> changes = {{claim_of("Ana", 1)}, {claim_of("the mole", 2)}};
  REQUIRE(store->change_names(changes).has_value());
}

/// Takes from a closed world what formats 3 and 4 added.
void make_format_2(const std::string& file) {
  REQUIRE(
      raw_sql(
          file,
          "DROP TABLE tile; DROP TABLE name_claim; DROP TABLE rights_record; DELETE FROM meta WHERE key IN "
          "('name_claim_fold', 'rights_record_fold'); "
          "PRAGMA user_version = 2; SELECT 'done'") == "done");
}

}  // namespace

TEST_CASE("claims of names are there again after the world is opened", "[store][names]") {
  TempPlace place;
  make_claims(place.path());
  {
    const auto store = claimed_world(place.path(), StoreAccess::read_write);
    CHECK(*store->name_claims() == std::vector{claim_of("Ana", 1), claim_of("the mole", 2)});
    CHECK(store->check().has_value());
    const std::vector<NameChange> changes = {{claim_of("Ana", 1), true}, {claim_of("bob", 1)}};
    REQUIRE(store->change_names(changes).has_value());
    REQUIRE(store->change_names(changes).has_value());  // a repetition changes nothing
  }
  const auto store = claimed_world(place.path(), StoreAccess::read_only);
  CHECK(*store->name_claims() == std::vector{claim_of("bob", 1), claim_of("the mole", 2)});
}

TEST_CASE("a name that another key owns is not claimed", "[store][names]") {
  TempPlace place;
  make_claims(place.path());
  const auto store = claimed_world(place.path(), StoreAccess::read_write);
  const std::vector<NameChange> changes = {{claim_of("eve", 3)}, {claim_of("ANA", 3)}};
  const auto changed = store->change_names(changes);
  REQUIRE_FALSE(changed.has_value());
  CHECK(changed.error().kind == StoreError::Kind::bad_request);
  CHECK(*store->name_claims() == std::vector{claim_of("Ana", 1), claim_of("the mole", 2)});
}

TEST_CASE("a damaged claim and a missing one are noticed", "[store][names][loss][sqlite]") {
  TempPlace place;
  make_claims(place.path());
  const std::string file = place / "world.sqlite";
  SECTION("a key that was exchanged") {
    REQUIRE(raw_sql(file, "UPDATE name_claim SET key = zeroblob(32) WHERE folded = 'ana'").empty());
    const auto claims = claimed_world(place.path(), StoreAccess::read_write)->name_claims();
    REQUIRE_FALSE(claims.has_value());
    CHECK(claims.error().message() == file + ": name_claim folded=\"ana\": checksum is wrong");
  }
  SECTION("a row that is gone") {
    REQUIRE(raw_sql(file, "DELETE FROM name_claim WHERE folded = 'ana'").empty());
    CHECK_FALSE(claimed_world(place.path(), StoreAccess::read_write)->name_claims().has_value());
    {
      const auto repaired = claimed_world(place.path(), StoreAccess::repair);
      const auto lost = repaired->accept_losses();
      REQUIRE(lost.has_value());
      REQUIRE(lost->size() == 1);
      CHECK(lost->front().find("name_claim") != std::string::npos);
    }
    const auto store = claimed_world(place.path(), StoreAccess::read_write);
    CHECK(*store->name_claims() == std::vector{claim_of("the mole", 2)});
  }
}

TEST_CASE("a world of format 2 is converted: the oldest player of a name owns it",
          "[store][names][sqlite]") {
  TempPlace place;
  const std::string file = place / "world.sqlite";
  {
    const auto store = *create_world(place.path(), sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    std::vector<PlayerRow> players;
    for (AuthorId author = 1; author <= 5; ++author) players.push_back(sample_player(author));
    players[0].name = "Ana";
    players[1].name = "bob";
    players[2].name = "ANA";
    players[3].name = "\u0430na";  // no player may have this name any more
    players[4].name = "bob";
    SplitMix64 rng(5);
    REQUIRE(store->append(players, sample_records(rng, 1, 1, 20)).has_value());
  }
  make_format_2(file);
  CHECK(claimed_world(place.path(), StoreAccess::read_only)->name_claims()->empty());
  CHECK(raw_sql(file, "PRAGMA user_version") == "2");  // a reader converts nothing
  {
    const auto store = claimed_world(place.path(), StoreAccess::read_write);
    CHECK(*store->name_claims() == std::vector{claim_of("Ana", 1), claim_of("bob", 2)});
    CHECK(store->players()->size() == 5);
    CHECK(store->check().has_value());
  }
  CHECK(raw_sql(file, "PRAGMA user_version") == "5");
  CHECK(claimed_world(place.path(), StoreAccess::read_write)->name_claims()->size() == 2);
}
