// Retention while a log writer writes.
#include "server/runtime/retention_thread.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

#include "server/runtime/logging.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/unit/server/history/retention_world.hpp"

namespace runstone::test {
namespace {

constexpr RetentionPace kQuick{0, std::chrono::hours(24), std::chrono::hours(24),
                               std::chrono::milliseconds(5)};
constexpr RetentionPace kAtOnce{0, std::chrono::milliseconds(1), std::chrono::hours(24),
                                std::chrono::milliseconds(5)};

/// A world of 120 hourly edits with a log writer.
struct RetentionBench {
  RetentionBench() {
    start_logging(LogLevel::error, LogFormat::text);
    SplitMix64 rng(3);
    make_retention_world(folder.path(), rng, {40});
    store = opened_retention_world(folder.path(), StoreAccess::read_write);
    REQUIRE(store->raise_epoch().has_value());
    at_end = moment_chunks(*store, kRetentionEdits);
    generator = retention_generator(*store);
    writer = std::make_unique<LogWriter>(*store, LogWriter::Callbacks{});
  }
  void begin(std::uint64_t days, const RetentionPace& pace) {
    retention = std::make_unique<RetentionThread>(
        folder.path(), *generator, *writer, days,
        [this] {
          while (!may_plan.load()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
          return retention_time(1'000);
        },
        pace);
  }
  void await(const std::function<bool(const RetentionState&)>& is_done) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!is_done(retention->state()) && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    REQUIRE(is_done(retention->state()));
  }
  /// Ends the threads and checks the world. Returns the head of its log.
  Sequence stopped_head() {
    retention->stop();
    writer->stop();
    const auto sound = store->check();
    if (!sound) FAIL(sound.error().message());
    CHECK(moment_chunks(*store, *store->last_sequence()) == at_end);
    return store->log_head()->version.seq;
  }

  const TempFolder folder;
  std::unique_ptr<Store> store;
  MomentChunks at_end;
  std::atomic<bool> may_plan{true};  // a run that plans waits for it
  std::unique_ptr<Generator> generator;
  std::unique_ptr<LogWriter> writer;
  std::unique_ptr<RetentionThread> retention;
};

}  // namespace

TEST_CASE("a policy removes old edits by itself and counts what it did", "[server][retention]") {
  RetentionBench bench;
  bench.begin(2, kAtOnce);
  bench.await([](const RetentionState& state) { return state.runs == 1; });
  const RetentionState state = bench.retention->state();
  CHECK(state.edits == 72);
  CHECK(state.parts >= 1);
  CHECK(state.writer_us >= state.writer_us_max);
  CHECK(state.head.version.seq == 72);
  CHECK(state.failure.empty());
  CHECK_FALSE(state.is_running);
  CHECK(bench.stopped_head() == 72);
}

TEST_CASE("without a policy nothing is removed until a person orders it", "[server][retention]") {
  RetentionBench bench;
  bench.begin(0, kQuick);
  CHECK_FALSE(bench.retention->cancel());
  REQUIRE(bench.retention->run_now(3));
  bench.await([](const RetentionState& state) { return state.runs == 1; });
  CHECK(bench.stopped_head() == 48);
}

TEST_CASE("a run waits while it is held, and ends when it is cancelled", "[server][retention]") {
  RetentionBench bench;
  bench.begin(0, kQuick);
  bench.retention->hold(true);
  REQUIRE(bench.retention->run_now(2));
  CHECK_FALSE(bench.retention->run_now(1));
  bench.await([](const RetentionState& state) { return !state.waits_for.empty(); });
  CHECK(bench.retention->state().edits == 0);
  REQUIRE(bench.retention->cancel());
  bench.await([](const RetentionState& state) { return !state.is_running; });
  CHECK(bench.stopped_head() == 0);
}

TEST_CASE("new days end a run of the policy, and the next one does not begin at once",
          "[server][retention]") {
  RetentionBench bench;
  bench.may_plan = false;
  bench.begin(2, kAtOnce);
  bench.retention->hold(true);
  bench.may_plan = true;
  bench.await([](const RetentionState& state) { return !state.waits_for.empty(); });
  bench.retention->set_days(1);
  bench.await([](const RetentionState& state) { return state.runs == 1; });
  bench.retention->hold(false);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK_FALSE(bench.retention->state().is_running);
  CHECK(bench.retention->state().days == 1);
  // A run that a person has ordered does not wait.
  REQUIRE(bench.retention->run_now(3));
  bench.await([](const RetentionState& state) { return state.runs == 2; });
  CHECK(bench.stopped_head() == 48);
}

TEST_CASE("new days do not end a run that a person ordered", "[server][retention]") {
  RetentionBench bench;
  bench.begin(0, kQuick);
  bench.retention->hold(true);
  REQUIRE(bench.retention->run_now(2));
  bench.await([](const RetentionState& state) { return !state.waits_for.empty(); });
  bench.retention->set_days(1);
  bench.retention->hold(false);
  bench.await([](const RetentionState& state) { return state.runs == 1; });
  CHECK(bench.stopped_head() == 72);
}

TEST_CASE("records that come during a run are written as well", "[server][retention]") {
  RetentionBench bench;
  bench.begin(0, {9, std::chrono::hours(24), std::chrono::hours(24), std::chrono::milliseconds(5)});
  REQUIRE(bench.retention->run_now(2));
  SplitMix64 rng(4);
  for (Sequence seq = kRetentionEdits + 1; seq <= kRetentionEdits + 30; ++seq) {
    EditRecord record;
    record.version = {2, seq};
    record.op = {1, 77, seq};
    record.time_us = retention_time(seq);
    record.edit.shape = SetVoxel{{static_cast<std::int32_t>(seq), 5, 5}};
    record.edit.material = 1;
    bench.writer->append({}, {record});
  }
  bench.await([](const RetentionState& state) { return state.runs == 1; });
  bench.retention->stop();
  bench.writer->stop();
  CHECK(*bench.store->last_sequence() == kRetentionEdits + 30);
  CHECK(bench.store->log_head()->version.seq >= 72);
  CHECK(bench.store->check().has_value());
}

TEST_CASE("a run that fails says why, and leaves the world as it is", "[server][retention]") {
  RetentionBench bench;
  REQUIRE(raw_sql(bench.folder / "world.sqlite",
                  "UPDATE edit_log SET time_us = time_us + 1 WHERE seq = 20; SELECT changes()") ==
          "1");
  bench.begin(0, kQuick);
  REQUIRE(bench.retention->run_now(2));
  bench.await([](const RetentionState& state) { return state.runs == 1; });
  CHECK(bench.retention->state().failures == 1);
  CHECK(bench.retention->state().failure.find("edit_log seq=20: checksum is wrong") !=
        std::string::npos);
  bench.retention->stop();
  bench.writer->stop();
  CHECK(bench.store->log_head()->version.seq < 20);
}

}  // namespace runstone::test
