// The lease of a world in PostgreSQL: one program at a time writes it. The cases need a server, as those
// of postgres_database_test.cpp.
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "common/tiles/tile_rules.hpp"
#include "server/store/postgres_lease.hpp"
#include "server/store/world_schema.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/unit/server/store/comes_true.hpp"

using namespace runstone;
using namespace runstone::test;
using std::chrono::milliseconds;

namespace {

const LeaseTerms kLong{"first", milliseconds(600'000)};  // is not renewed during a case
const LeaseTerms kShort{"second", milliseconds(200)};
constexpr const char* kEnd = "UPDATE lease SET expires_us = 0";

std::unique_ptr<Store> create_as(const std::string& place, const LeaseTerms& lease) {
  auto store = create_world(place, sample_meta(), "", lease);
  INFO((store ? std::string() : store.error().message()));
  REQUIRE(store.has_value());
  return *std::move(store);
}
std::unique_ptr<Store> open_as(const std::string& place, const LeaseTerms& lease) {
  auto store = open_world(place, StoreAccess::read_write, "", lease);
  INFO((store ? std::string() : store.error().message()));
  REQUIRE(store.has_value());
  return *std::move(store);
}

/// Makes a world and opens it again under this lease, as a server does.
std::unique_ptr<Store> start_as(const std::string& place, const LeaseTerms& lease) {
  create_as(place, lease).reset();
  auto store = open_as(place, lease);
  REQUIRE(*store->raise_epoch() == 1);
  return store;
}

/// Returns a connection that keeps an advisory lock of the world's schema.
sql::Database holder_of(const std::string& place, std::int64_t lock) {
  auto holder = *sql::open_postgres(place, sql::PostgresMode::write);
  const std::string take =
      "SELECT pg_advisory_lock(" + std::to_string(lock) +
      ", (SELECT oid::int FROM pg_namespace WHERE nspname = current_schema()))";
  REQUIRE(holder.run(take.c_str()).has_value());
  return holder;
}

/// Returns the connection of an owner that stands still in a transaction.
sql::Database stuck_owner(const std::string& place) {
  auto stuck = holder_of(place, kApplicationId);
  REQUIRE(stuck
              .run("BEGIN; SELECT * FROM lease FOR SHARE; "
                   "INSERT INTO edit_log SELECT 0, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, '', 0")
              .has_value());
  return stuck;
}

}  // namespace

TEST_CASE("the owner of a world is named, and gives the world back", "[.postgres-server]") {
  TempPlace place;
  LeaseWatch watch(place.path());
  CHECK_FALSE(watch.owner()->has_value());
  auto store = create_as(place.path(), {"first", milliseconds(5'000)});
  CHECK(store->is_owned());
  REQUIRE(watch.owner()->has_value());
  CHECK((*watch.owner())->name == "first");
  CHECK(std::to_string((*watch.owner())->term) == raw_sql(place.path(), "SELECT term FROM lease"));
  const auto other = open_world(place.path(), StoreAccess::read_write, "", kShort);
  REQUIRE_FALSE(other.has_value());
  CHECK(other.error().kind == StoreError::Kind::locked);
  CHECK(other.error().message().find("is writing this world: first") != std::string::npos);
  CHECK(open_world(place.path(), StoreAccess::read_only).has_value());
  store.reset();
  CHECK_FALSE(watch.owner()->has_value());
}

TEST_CASE("a program that does not wait for a lease hears at once who has it",
          "[.postgres-server]") {
  TempPlace place;
  const auto store = start_as(place.path(), kLong);  // it is not renewed: others would wait for it
  LeaseTerms impatient = kShort;
  impatient.waits = false;
  const auto other = open_world(place.path(), StoreAccess::read_write, "", impatient);
  REQUIRE_FALSE(other.has_value());
  CHECK(other.error().kind == StoreError::Kind::locked);
  CHECK(other.error().message().find("is writing this world: first") != std::string::npos);
}

TEST_CASE("the lease of a program that has ended runs out", "[.postgres-server]") {
  TempPlace place;
  create_as(place.path(), kLong).reset();
  const std::string term = raw_sql(place.path(), "SELECT term FROM lease");
  raw_sql(place.path(),
          "UPDATE lease SET owner = 'ghost', expires_us = "
          "(extract(epoch FROM clock_timestamp()) * 1000000)::bigint + 300000");
  const auto store = open_as(place.path(), kLong);
  CHECK(std::stoll(raw_sql(place.path(), "SELECT term FROM lease")) > std::stoll(term));
  CHECK(raw_sql(place.path(), "SELECT owner FROM lease") == "first");
}

TEST_CASE("others find the address that the owner publishes, until another takes the world",
          "[.postgres-server]") {
  TempPlace place;
  LeaseWatch watch(place.path());
  const auto address = [&] {
    const auto owner = watch.owner();
    REQUIRE(owner.has_value());
    REQUIRE(owner->has_value());
    return (*owner)->address;
  };
  auto store = start_as(place.path(), kLong);
  const std::int64_t term = (*watch.owner())->term;
  CHECK(address().empty());
  REQUIRE(store->publish_address("one.example:4747").has_value());
  CHECK(**watch.owner() == LeaseOwner{"first", "one.example:4747", term});
  REQUIRE(store->publish_address("[2001:db8::7]:5000").has_value());
  CHECK(address() == "[2001:db8::7]:5000");
  SplitMix64 rng(1);
  CHECK(store->append({}, sample_records(rng, 1, 1, 3)).has_value());
  CHECK(address() == "[2001:db8::7]:5000");

  const auto reader = open_world(place.path(), StoreAccess::read_only);
  REQUIRE(reader.has_value());
  CHECK((*reader)->publish_address("reader.example:1").error().kind ==
        StoreError::Kind::bad_request);
  CHECK(address() == "[2001:db8::7]:5000");

  store.reset();
  CHECK_FALSE(watch.owner()->has_value());
  store = open_as(place.path(), kLong);
  CHECK(address().empty());
  CHECK((*watch.owner())->term > term);
}

TEST_CASE("a program that lost the lease publishes no address", "[.postgres-server]") {
  TempPlace place;
  LeaseWatch watch(place.path());
  auto paused = start_as(place.path(), kLong);
  raw_sql(place.path(), "UPDATE lease SET owner = 'other', term = term + 1");
  const auto published = paused->publish_address("one.example:4747");
  REQUIRE_FALSE(published.has_value());
  CHECK(published.error().kind == StoreError::Kind::locked);
  CHECK(published.error().message().find("other has taken this world over") != std::string::npos);
  CHECK((*watch.owner())->address.empty());
}

TEST_CASE("a table of the lease without the address is read, and gets it with the next owner",
          "[.postgres-server]") {
  TempPlace place;
  create_as(place.path(), kLong).reset();
  raw_sql(place.path(),
          "DROP TABLE lease; CREATE TABLE lease(shard BIGINT NOT NULL PRIMARY KEY, "
          "owner TEXT NOT NULL, term BIGINT NOT NULL, expires_us BIGINT NOT NULL); "
          "INSERT INTO lease SELECT 0, 'older', 7, "
          "(extract(epoch FROM clock_timestamp()) * 1000000)::bigint + 600000000");
  LeaseWatch watch(place.path());
  REQUIRE(watch.owner().has_value());
  REQUIRE(watch.owner()->has_value());
  CHECK(**watch.owner() == LeaseOwner{"older", "", 7});
  raw_sql(place.path(), kEnd);
  auto stuck = stuck_owner(place.path());
  auto store = open_as(place.path(), kLong);
  CHECK_FALSE(stuck.run("COMMIT").has_value());
  REQUIRE(watch.owner()->has_value());
  CHECK((*watch.owner())->name == "first");
  CHECK((*watch.owner())->address.empty());
  CHECK(store->raise_epoch().has_value());
  REQUIRE(store->publish_address("one.example:4747").has_value());
  CHECK((*watch.owner())->address == "one.example:4747");
}

TEST_CASE("a long read of the lease's table, as of a backup, does not delay the next owner",
          "[.postgres-server]") {
  TempPlace place;
  create_as(place.path(), kLong).reset();
  auto backup = *sql::open_postgres(place.path(), sql::PostgresMode::read);
  REQUIRE(backup.run("BEGIN; SELECT * FROM lease").has_value());
  auto opened = std::async(std::launch::async, [&] {
    return open_world(place.path(), StoreAccess::read_write, "", kLong);
  });
  const bool is_open = opened.wait_for(std::chrono::seconds(30)) == std::future_status::ready;
  CHECK(is_open);
  REQUIRE(backup.run("COMMIT").has_value());
  const auto store = opened.get();
  REQUIRE(store.has_value());
  CHECK((*store)->is_owned());
}

TEST_CASE("a program that was paused beyond its lease writes nothing more", "[.postgres-server]") {
  TempPlace place;
  SplitMix64 rng(1);
  auto paused = start_as(place.path(), kLong);
  REQUIRE(paused->append({}, sample_records(rng, 1, 1, 3)).has_value());
  raw_sql(place.path(), kEnd);
  auto next = open_as(place.path(), kLong);
  REQUIRE(*next->raise_epoch() == 2);
  REQUIRE(next->append({}, sample_records(rng, 2, 4, 2)).has_value());
  CHECK_FALSE(paused->append({}, sample_records(rng, 1, 4, 5)).has_value());
  CHECK_FALSE(paused->raise_epoch().has_value());
  paused.reset();  // does not give the lease of the other back
  CHECK(next->append({}, sample_records(rng, 2, 6, 1)).has_value());
  CHECK(*next->last_sequence() == 6);
  CHECK(next->check().has_value());
}

TEST_CASE("every write confirms the lease, also on a connection that is alive",
          "[.postgres-server]") {
  TempPlace place;
  SplitMix64 rng(1);
  auto store = start_as(place.path(), kLong);
  const auto records = sample_records(rng, 1, 1, 3);
  raw_sql(place.path(), "UPDATE lease SET owner = 'other', term = term + 1");
  const auto refused = [](const StoreResult<void>& written) {
    REQUIRE_FALSE(written.has_value());
    CHECK(written.error().kind == StoreError::Kind::locked);
    CHECK(written.error().message().find("other has taken this world over") != std::string::npos);
  };
  refused(store->append({}, records));
  refused(store->save_snapshots({}, Sequence{0}));
  refused(store->save_tiles({}, kTileRules));
  refused(store->save_keyframe({}, std::nullopt));
  CHECK_FALSE(store->raise_epoch().has_value());
  CHECK(*store->last_sequence() == 0);
}

TEST_CASE("a lease that ran out and that nobody took goes on with the next write",
          "[.postgres-server]") {
  TempPlace place;
  SplitMix64 rng(1);
  auto store = start_as(place.path(), kLong);
  raw_sql(place.path(), kEnd);
  CHECK(store->append({}, sample_records(rng, 1, 1, 3)).has_value());
  CHECK(raw_sql(place.path(), "SELECT expires_us > 0 FROM lease") == "t");
}

TEST_CASE("an owner hears that its world was taken over", "[.postgres-server]") {
  TempPlace place;
  create_as(place.path(), kLong).reset();
  auto store = open_as(place.path(), {"first", milliseconds(300)});
  std::promise<std::string> told;
  store->watch_ownership([&](const StoreError& error) { told.set_value(error.message()); });
  raw_sql(place.path(), "UPDATE lease SET owner = 'other', term = term + 1");
  auto words = told.get_future();
  REQUIRE(words.wait_for(std::chrono::minutes(1)) == std::future_status::ready);
  CHECK(words.get().find("other has taken this world over") != std::string::npos);
  CHECK_FALSE(store->is_owned());
  int calls = 0;
  store->watch_ownership([&](const StoreError&) { ++calls; });
  CHECK(calls == 1);
  store->watch_ownership({});
}

TEST_CASE(
    "an owner that cannot renew its lease stops before it can have run out, and goes on later",
    "[.postgres-server]") {
  TempPlace place;
  create_as(place.path(), kLong).reset();
  auto store = open_as(place.path(), kShort);
  CHECK(comes_true([&] { return store->is_owned(); }));
  raw_sql(place.path(), "ALTER TABLE lease RENAME TO hidden");
  CHECK(comes_true([&] { return !store->is_owned(); }));
  raw_sql(place.path(), "ALTER TABLE hidden RENAME TO lease");
  CHECK(comes_true([&] { return store->is_owned(); }));
}

TEST_CASE("an owner that has nothing to write hears that its connection was ended",
          "[.postgres-server]") {
  TempPlace place;
  create_as(place.path(), kLong).reset();
  auto store = open_as(place.path(), kShort);
  std::promise<std::string> told;
  store->watch_ownership([&](const StoreError& error) { told.set_value(error.message()); });
  raw_sql(place.path(),
          "SELECT count(pg_terminate_backend(pid)) FROM pg_locks WHERE locktype = 'advisory' AND "
          "objid = (SELECT oid FROM pg_namespace WHERE nspname = current_schema())");
  auto words = told.get_future();
  REQUIRE(words.wait_for(std::chrono::minutes(1)) == std::future_status::ready);
  CHECK(words.get().find("the connection that writes this world has ended") != std::string::npos);
  CHECK_FALSE(store->is_owned());
}

TEST_CASE("of programs that take a world at the same time, one gets it and the others hear of it",
          "[.postgres-server]") {
  TempPlace place;
  create_as(place.path(), kLong).reset();
  for (int round = 0; round < 5; ++round) {
    std::vector<std::future<StoreResult<std::unique_ptr<Store>>>> programs;
    for (int i = 0; i < 4; ++i) {
      programs.push_back(std::async(std::launch::async, [&, i] {
        const LeaseTerms terms{std::to_string(i), milliseconds(600)};
        return open_world(place.path(), StoreAccess::read_write, "", terms);
      }));
    }
    std::vector<StoreResult<std::unique_ptr<Store>>> results;
    for (auto& program : programs) results.push_back(program.get());
    int owners = 0;
    for (auto& result : results) {
      owners += result ? 1 : 0;
      if (!result) CHECK(result.error().kind == StoreError::Kind::locked);
      if (result) CHECK((*result)->raise_epoch().has_value());
    }
    CHECK(owners == 1);
  }
}

TEST_CASE("a transaction that its program never ends does not keep others out",
          "[.postgres-server]") {
  TempPlace place;
  create_as(place.path(), kLong).reset();
  auto stuck = stuck_owner(place.path());
  SplitMix64 rng(1);
  auto store = open_as(place.path(), kLong);
  REQUIRE(store->raise_epoch().has_value());
  CHECK(store->append({}, sample_records(rng, 1, 1, 3)).has_value());
  CHECK_FALSE(stuck.run("COMMIT").has_value());
}

TEST_CASE("a program that stands still while it takes the lease does not keep others out",
          "[.postgres-server]") {
  TempPlace place;
  create_as(place.path(), kLong).reset();
  auto stuck = holder_of(place.path(), kApplicationId + 1);
  const auto store = open_as(place.path(), kLong);  // after some ten seconds
  CHECK(store->is_owned());
  CHECK_FALSE(stuck.run("SELECT 1").has_value());
}

TEST_CASE("an owner that does not reach the database for long hears that it may own nothing",
          "[.postgres-server]") {
  TempPlace place;
  create_as(place.path(), kLong).reset();
  LeaseTerms terms = kShort;
  terms.alone_max = milliseconds(500);
  auto store = open_as(place.path(), terms);
  std::promise<std::string> told;
  store->watch_ownership([&](const StoreError& error) { told.set_value(error.message()); });
  auto words = told.get_future();
  CHECK(words.wait_for(milliseconds(600)) == std::future_status::timeout);  // renewals succeed
  raw_sql(place.path(), "ALTER TABLE lease RENAME TO hidden");
  REQUIRE(words.wait_for(std::chrono::minutes(1)) == std::future_status::ready);
  CHECK(words.get().find("another server may own the world") != std::string::npos);
  CHECK_FALSE(store->is_owned());
  raw_sql(place.path(), "ALTER TABLE hidden RENAME TO lease");
}

TEST_CASE("nobody takes the lease between its confirmation and the commit", "[.postgres-server]") {
  TempPlace place;
  auto store = start_as(place.path(), kLong);
  REQUIRE(raw_sql(place.path(),
                  "CREATE FUNCTION wait() RETURNS trigger AS $$ BEGIN PERFORM pg_sleep(2); "
                  "RETURN NULL; END $$ LANGUAGE plpgsql; "
                  "CREATE CONSTRAINT TRIGGER wait AFTER INSERT ON edit_log DEFERRABLE "
                  "INITIALLY DEFERRED FOR EACH ROW EXECUTE FUNCTION wait()")
              .find("ERROR") == std::string::npos);
  auto written = std::async(std::launch::async, [&] {
    SplitMix64 rng(1);
    return store->append({}, sample_records(rng, 1, 1, 1));  // it waits in its commit
  });
  CHECK(comes_true([&] {
    return raw_sql(place.path(),
                   "SELECT count(*) FROM pg_stat_activity WHERE wait_event = 'PgSleep'") == "1";
  }));
  const std::string taken =
      raw_sql(place.path(),
              "SET lock_timeout = '200ms'; UPDATE lease SET owner = 'other', term = term + 1");
  CHECK(taken.find("ERROR") == 0);
  CHECK(taken.find("lock timeout") != std::string::npos);
  CHECK(written.get().has_value());
  CHECK(raw_sql(place.path(), "SELECT owner FROM lease") == "first");
}
