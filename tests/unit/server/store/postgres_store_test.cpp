// Properties of a world in PostgreSQL that one in a file does not have. The cases need a server, as
// those of postgres_database_test.cpp.
#include <catch2/catch.hpp>
#include <chrono>

#include "common/core/epoch_branch.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

StoreError::Kind kind_of_opening(const std::string& place) {
  const auto store = open_world(place, StoreAccess::read_only);
  REQUIRE_FALSE(store.has_value());
  return store.error().kind;
}

}  // namespace

TEST_CASE("a schema without a world, of another program or of a newer one is refused",
          "[.postgres-server]") {
  TempPlace place;
  CHECK(kind_of_opening(place.path()) == StoreError::Kind::not_a_world);
  CHECK(create_world(place.path(), sample_meta()).has_value());
  CHECK(open_world(place.path(), StoreAccess::read_only).has_value());
  raw_sql(place.path(), "UPDATE runstone_world SET format = 4294967301");
  CHECK(kind_of_opening(place.path()) == StoreError::Kind::newer_version);
  raw_sql(place.path(), "UPDATE runstone_world SET application = 1, format = 5");
  CHECK(kind_of_opening(place.path()) == StoreError::Kind::not_a_world);
  raw_sql(place.path(), "DELETE FROM runstone_world");
  CHECK(kind_of_opening(place.path()) == StoreError::Kind::not_a_world);
  CHECK(create_world(place.path(), sample_meta()).error().kind == StoreError::Kind::exists);
  const std::string nowhere = place.path() + "x";  // a schema that is not there
  CHECK(create_world(nowhere, sample_meta()).error().kind == StoreError::Kind::not_a_world);
}

TEST_CASE("a store whose connection has ended writes nothing more", "[.postgres-server]") {
  TempPlace place;
  SplitMix64 rng(1);
  auto store = *create_world(place.path(), sample_meta(), "", {"", std::chrono::milliseconds(200)});
  REQUIRE(store->raise_epoch().has_value());
  REQUIRE(store->append({}, sample_records(rng, 1, 1, 3)).has_value());
  raw_sql(place.path(),
          "SELECT count(pg_terminate_backend(pid, 5000)) FROM pg_stat_activity "
          "WHERE application_name = 'runstone'");
  const auto next = sample_records(rng, 1, 4, 2);
  CHECK(store->append({}, next).error().kind == StoreError::Kind::io);
  CHECK(store->append({}, next).error().kind == StoreError::Kind::io);
  store.reset();
  auto other = *open_world(place.path(), StoreAccess::read_write);
  CHECK(*other->last_sequence() == 3);
  CHECK(other->check().has_value());
}

TEST_CASE("a database that was put back goes on in a new branch if the operator says so",
          "[.postgres-server]") {
  TempPlace place;
  auto store = *create_world(place.path(), sample_meta());
  REQUIRE(*store->raise_epoch() == 1);
  store.reset();
  store = *open_world(place.path(), StoreAccess::repair);
  REQUIRE(store->accept_losses().has_value());
  const Epoch branch = *store->raise_epoch();
  CHECK(branch > next_branch(1, 0));
}
