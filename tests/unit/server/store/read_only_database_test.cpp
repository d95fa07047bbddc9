// A database that takes no writes for a while: the world waits and loses nothing. The cases need a
// server, as those of postgres_database_test.cpp.
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <thread>

#include "server/store/log_writer.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/unit/server/store/comes_true.hpp"

using namespace runstone;
using namespace runstone::test;
using std::chrono::milliseconds;

namespace {

/// Refuses each write to a table with the error of a read-only database while it lives.
class ReadOnlyTable {
 public:
  ReadOnlyTable(std::string place, std::string table)
      : place_(std::move(place)), table_(std::move(table)) {
    run("CREATE OR REPLACE FUNCTION refuse() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RAISE "
        "EXCEPTION 'cannot execute INSERT in a read-only transaction' USING ERRCODE = '25006'; "
        "END $$");
    run("CREATE TRIGGER refuse BEFORE INSERT OR UPDATE ON " + table_ +
        " FOR EACH STATEMENT EXECUTE FUNCTION refuse()");
  }
  ~ReadOnlyTable() { run("DROP TRIGGER refuse ON " + table_); }
  ReadOnlyTable(const ReadOnlyTable&) = delete;
  ReadOnlyTable& operator=(const ReadOnlyTable&) = delete;

 private:
  void run(const std::string& sql) { CHECK(raw_sql(place_, sql).empty()); }
  const std::string place_, table_;
};

}  // namespace

TEST_CASE("edits wait while the database takes no writes, and none is lost", "[.postgres-server]") {
  TempPlace place;
  SplitMix64 rng(1);
  auto store = *create_world(place.path(), sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  std::atomic<Sequence> durable{0};
  std::atomic<DiskSpace> space{DiskSpace::enough};
  std::atomic<bool> has_failed{false}, says_read_only{false};
  LogWriter::Callbacks callbacks;
  callbacks.on_durable = [&](Sequence seq) { durable = seq; };
  callbacks.on_failed = [&](const StoreError&) { has_failed = true; };
  callbacks.on_space = [&](DiskSpace now, const std::string& reason) {
    if (now == DiskSpace::read_only)
      says_read_only = reason.find("read-only transaction") != std::string::npos;
    space = now;
  };
  LogWriter::Limits limits;
  limits.space_interval = milliseconds(20);
  LogWriter writer(*store, std::move(callbacks), limits);
  writer.append({}, sample_records(rng, 1, 1, 3));
  REQUIRE(comes_true([&] { return durable == 3; }));
  {
    const ReadOnlyTable read_only(place.path(), "edit_log");
    writer.append({}, sample_records(rng, 1, 4, 3));
    REQUIRE(comes_true([&] { return space == DiskSpace::read_only; }));
    CHECK(says_read_only);
    CHECK_FALSE(writer.has_room(1));
    CHECK(durable == 3);
  }
  REQUIRE(comes_true([&] { return durable == 6; }));
  CHECK(comes_true([&] { return writer.has_room(1); }));
  CHECK(space == DiskSpace::enough);
  writer.stop();
  CHECK_FALSE(has_failed);
  CHECK(*store->last_sequence() == 6);
  CHECK(store->check().has_value());
}

TEST_CASE("an owner does not give up the world because the database takes no writes",
          "[.postgres-server]") {
  TempPlace place;
  LeaseTerms terms{"owner", milliseconds(300)};
  terms.alone_max = milliseconds(300);
  auto store = *create_world(place.path(), sample_meta(), "", terms);
  std::atomic<bool> is_lost{false};
  store->watch_ownership([&](const StoreError&) { is_lost = true; });
  {
    const ReadOnlyTable read_only(place.path(), "lease");
    REQUIRE(comes_true([&] { return !store->is_owned(); }));
    std::this_thread::sleep_for(milliseconds(900));  // three times alone_max
  }
  CHECK(comes_true([&] { return store->is_owned(); }));
  CHECK_FALSE(is_lost);
  store->watch_ownership({});
}
