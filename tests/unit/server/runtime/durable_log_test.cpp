#include "server/runtime/durable_log.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "server/runtime/logging.hpp"
#include "server/store/world_folder.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

/// The log of a new world. Its events are kept as text. run() runs the tasks that were posted
/// before.
struct LogBench {
  LogBench() {
    start_logging(LogLevel::error);
    WorldCreation creation;
    creation.generator = "flat";
    creation.seed = 1;
    creation.edge = kSampleEdge;
    auto opened = open_or_create_world(folder / "world", creation);
    REQUIRE(opened.has_value());
    world = *std::move(opened);
    REQUIRE(world.store->raise_epoch().has_value());
    DurableLog::Events to;
    to.on_durable = [this](Sequence seq) { events.push_back("durable " + std::to_string(seq)); };
    to.on_snapshots_saved = [this] { events.emplace_back("saved"); };
    to.on_failed = [this] { events.emplace_back("failed"); };
    to.on_failed_in_writer = [this] { has_failed_in_writer = true; };
    log = std::make_unique<DurableLog>(strand, *world.store, folder / "world", *world.generator,
                                       DurableLog::Options{}, std::move(to));
  }
  void append(Sequence seq) {
    const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
    log->writer().append(seq == 1 ? players : std::vector<PlayerRow>{},
                         {sample_record(rng, 1, seq)});
  }
  void run() {
    io.restart();
    io.run();
  }

  const TempFolder folder;
  SplitMix64 rng{1};
  asio::io_context io;
  WorldStrand strand{io, [] {}};
  OpenedWorld world;
  std::vector<std::string> events;
  std::atomic<bool> has_failed_in_writer{false};
  std::unique_ptr<DurableLog> log;
};

using Texts = std::vector<std::string>;

TEST_CASE("group commits become one report while the world strand does not run", "[server]") {
  LogBench bench;
  for (Sequence seq = 1; seq <= 20; ++seq) bench.append(seq);
  bench.log->stop();  // all of it is on disk
  CHECK(bench.events.empty());
  bench.run();
  CHECK(bench.events == Texts{"durable 20"});
  CHECK_FALSE(bench.log->has_failed());
}

TEST_CASE("snapshots are reported behind the edits that they contain", "[server]") {
  LogBench bench;
  bench.append(1);
  REQUIRE(bench.log->writer().save_snapshots({}, Sequence{1}));
  bench.log->stop();
  bench.run();
  CHECK(bench.events == Texts{"durable 1", "saved"});
}

TEST_CASE("a log that cannot be written is reported at once and on the world strand", "[server]") {
  LogBench bench;
  REQUIRE(raw_sql(bench.folder / "world/world.sqlite", "DROP TABLE edit_log").empty());
  bench.append(1);
  bench.log->stop();
  CHECK(bench.has_failed_in_writer);
  CHECK(bench.log->has_failed());
  CHECK(bench.events.empty());
  bench.run();
  CHECK(bench.events == Texts{"failed"});
}

}  // namespace
}  // namespace runstone::test
