// The log writer on a PostgreSQL database with a full disk, or without writes for a while. The cases
// need a server, as those of postgres_database_test.cpp.
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>

#include "server/store/log_writer.hpp"
#include "server/store/store.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/unit/server/store/comes_true.hpp"
#include "tests/unit/server/store/postgres_faults.hpp"

namespace runstone::test {
namespace {

using std::chrono::milliseconds;

/// A running writer of a new world behind a proxy.
struct WriterBehindProxy {
  WriterBehindProxy() {
    REQUIRE(store->raise_epoch().has_value());
    LogWriter::Callbacks callbacks;
    callbacks.on_durable = [this](Sequence seq) { durable = seq; };
    callbacks.on_failed = [this](const StoreError&) { has_failed = true; };
    callbacks.on_space = [this](DiskSpace now, const std::string&) { space = now; };
    LogWriter::Limits limits;
    limits.space_interval = milliseconds(1);
    writer.emplace(*store, std::move(callbacks), limits);
  }
  /// Queues two more edits.
  void append() {
    auto records = sample_records(rng, 1, log.size() + 1, 2);
    log.insert(log.end(), records.begin(), records.end());
    writer->append({sample_player(1), sample_player(2)}, std::move(records));
  }
  void check_log() {
    writer->stop();
    CHECK_FALSE(has_failed);
    CHECK(writer->counters().queued_records == 0);
    std::vector<EditRecord> read;
    const auto reader = *open_world(place.path(), StoreAccess::read_only);
    REQUIRE(reader->read_log(1, kSequenceMax, [&](const EditRecord& record) {
      read.push_back(record);
      return true;
    }));
    CHECK(read == log);
    CHECK(reader->check().has_value());
  }

  TempPlace place;
  FaultProxy proxy{place.path()};
  SplitMix64 rng{1};
  std::vector<EditRecord> log;
  std::unique_ptr<Store> store = *create_world(proxy.through(place.path()), sample_meta(), "",
                                               {"writer", std::chrono::minutes(10)});
  std::atomic<Sequence> durable{0};
  std::atomic<bool> has_failed{false};
  std::atomic<DiskSpace> space{DiskSpace::enough};
  std::optional<LogWriter> writer;
};

}  // namespace

TEST_CASE("edits wait while PostgreSQL has no room or takes no writes, and are written then",
          "[.postgres-server]") {
  for (const ProxyFault& fault : {full_disk(true), read_only_database(true)}) {
    CAPTURE(text_of(fault));
    WriterBehindProxy bench;
    bench.append();
    REQUIRE(comes_true([&] { return bench.durable == 2; }));
    const auto expected = fault.sqlstate == "53100" ? DiskSpace::full : DiskSpace::read_only;
    bench.proxy.fail(1, fault);
    bench.append();
    REQUIRE(comes_true([&] { return bench.space == expected; }));
    CHECK_FALSE(bench.writer->has_room(1));
    REQUIRE(bench.writer->has_queue_room(2));
    bench.append();  // the world had accepted it before it knew
    CHECK(bench.durable == 2);
    bench.proxy.heal();
    CHECK(comes_true([&] { return bench.durable == 6; }));
    CHECK(comes_true([&] { return bench.writer->has_room(1); }));
    bench.check_log();
  }
}

TEST_CASE("a full disk or a read-only database at any statement of a commit loses no edit",
          "[.postgres-server]") {
  for (const ProxyFault& fault : {full_disk(false), read_only_database(false)}) {
    WriterBehindProxy bench;
    bool strikes = true;
    for (std::uint64_t statement = 1; strikes; ++statement) {
      CAPTURE(statement, text_of(fault));
      bench.proxy.fail(statement, fault);
      bench.append();
      REQUIRE(comes_true([&] { return bench.durable == bench.log.size() || bench.has_failed; }));
      REQUIRE_FALSE(bench.has_failed);
      strikes = bench.proxy.has_failed();
    }
    bench.proxy.heal();
    CHECK(bench.log.size() > 20);
    bench.check_log();
  }
}

}  // namespace runstone::test
