// A job without workers: the test makes the plans. The room of the log and the author's rate are
// small.
#include "server/rollback/restore_job.hpp"

#include <catch2/catch.hpp>

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

constexpr SessionId kRestorer = 1;
constexpr ClientInstance kInstance = 77;
const ChunkKey kHere{0, {0, 0, 0}}, kThere{0, {1, 0, 0}};

std::shared_ptr<const Clipboard> one_cell() {
  ClipboardBuilder cells({1, 1, 1});
  cells.append(1, Material{1});
  return *cells.finish();
}

struct JobBench {
  explicit JobBench(AuthorId payer = 0, WorldConfig c = config())
      : bench(std::move(c)), author(bench.join(kRestorer, 1).author), job(order(payer)) {
    bench.view(kRestorer, kSmall);
  }
  static RestoreOrder order(AuthorId payer) {
    Selection selection;
    selection.chunks[kHere] = {1};
    selection.chunks[kThere] = {1};
    RestoreOrder order;
    order.author = payer;
    order.payer = payer;
    order.instance = kInstance;
    order.cause = payer == 0 ? Cause::rollback : Cause::undo;
    order.selection = std::make_shared<const Selection>(std::move(selection));
    return order;
  }
  /// Returns `count` edits of one voxel each.
  RestoredChunk planned(const ChunkKey& key, int count) const {
    RestoredChunk chunk;
    chunk.key = key;
    chunk.version = bench.server.order().chunks().version(key);
    chunk.voxels = static_cast<std::uint64_t>(count);
    for (int i = 0; i < count; ++i)
      chunk.edits.push_back({SetVoxel{{key.at.x * int{kEdge} + i, 2, 2}}, {}, 1});
    return chunk;
  }
  void plan_all(int edits) {
    REQUIRE(job.next_work(bench.server).has_value());
    job.computed({planned(kHere, edits), planned(kThere, edits)});
  }
  void write_log() {
    bench.environment.log_written = bench.environment.records.size();
    if (bench.server.order().head() > 0)
      bench.server.durable(bench.server.order().head(), bench.now());
  }
  void step() {
    bench.tick();
    job.step(bench.server, bench.now());
  }
  WorldBench bench;
  AuthorId author;
  RestoreJob job;
};

}  // namespace

TEST_CASE("a job whose slice has more edits than the log has room for writes it in parts",
          "[rollback]") {
  const auto room = static_cast<std::size_t>(GENERATE(1, 2, 3, 5, 9));
  CAPTURE(room);
  JobBench b;
  b.bench.environment.log_records_max = room;
  b.plan_all(5);
  int steps = 0;
  while (b.job.state() == RestoreJob::State::applying) {
    REQUIRE(++steps <= 10);
    const std::size_t before = b.bench.environment.records.size();
    b.step();
    CHECK(b.bench.environment.records.size() == std::min<std::size_t>(before + room, 10));
    b.step();  // the log is full
    CHECK(b.bench.environment.records.size() == std::min<std::size_t>(before + room, 10));
    if (b.job.state() == RestoreJob::State::applying)
      CHECK(b.job.progress().waits_for == "the log has no room now (log_queue_records)");
    b.write_log();
  }
  CHECK(b.job.state() == RestoreJob::State::done);
  const RestoreJob::Progress& p = b.job.progress();
  CHECK(p.edits == 10);
  CHECK(p.voxels == 10);
  CHECK(p.chunks_done == 2);
  CHECK(p.chunks_changed == 2);
  CHECK(p.collisions == 0);
  CHECK(p.waits_for.empty());
  CHECK(p.first == 1);
  CHECK(p.last == 10);
  for (std::size_t i = 0; i < 10; ++i) {
    CHECK(b.bench.environment.records[i].op == OperationId{0, kInstance, i + 1});
  }
}

TEST_CASE("a job plans further chunks while it has less than a slice", "[rollback]") {
  JobBench b;
  RestoreOrder order = JobBench::order(0);
  Selection selection;
  for (std::int32_t x = 0; x < 8; ++x) selection.chunks[{0, {x, 0, 0}}] = {1};
  order.selection = std::make_shared<const Selection>(std::move(selection));
  RestoreLimits limits;
  limits.slice_chunks = 3;
  limits.work_chunks = 2;
  RestoreJob job(order, limits);
  const auto plan = [&] {
    const auto work = job.next_work(b.bench.server);
    if (!work) return false;
    CHECK(work->items.size() == 2);
    CHECK_FALSE(job.next_work(b.bench.server).has_value());
    std::vector<RestoredChunk> chunks;
    for (const auto& item : work->items) chunks.push_back(b.planned(item.key, 1));
    job.computed(std::move(chunks));
    return true;
  };
  CHECK(plan());
  CHECK(plan());
  CHECK_FALSE(plan());
  job.step(b.bench.server, b.bench.now());
  CHECK(job.progress().chunks_done == 3);
  CHECK(plan());
  CHECK_FALSE(plan());
}

TEST_CASE("fills of a job that continue each other are one edit", "[rollback]") {
  JobBench bench;
  const auto filled = [&](const ChunkKey& key, Material material) {
    RestoredChunk chunk;
    chunk.key = key;
    chunk.version = bench.bench.server.order().chunks().version(key);
    const VoxelBox box = box_of(key.at, kEdge);
    chunk.voxels = volume_of(box);
    chunk.edits = {{FillBox{box}, {}, material}};
    return chunk;
  };
  REQUIRE(bench.job.next_work(bench.bench.server).has_value());
  SECTION("with one material") {
    bench.job.computed({filled(kHere, 1), filled(kThere, 1)});
    bench.step();
    const auto& records = bench.bench.environment.records;
    REQUIRE(records.size() == 1);
    CHECK(std::get<FillBox>(records[0].edit.shape).box ==
          VoxelBox{{0, 0, 0}, {2 * kEdge, kEdge, kEdge}});
    CHECK(bench.job.progress().edits == 1);
  }
  SECTION("not with two") {
    bench.job.computed({filled(kHere, 1), filled(kThere, 2)});
    bench.step();
    CHECK(bench.bench.environment.records.size() == 2);
    CHECK(bench.job.progress().edits == 2);
  }
  CHECK(bench.job.state() == RestoreJob::State::done);
  CHECK(bench.job.progress().chunks_done == 2);
  CHECK(bench.job.progress().voxels == 2ULL * kEdge * kEdge * kEdge);
}

TEST_CASE("the rest of a chunk is planned again if another player edits it between two parts",
          "[rollback]") {
  JobBench b;
  b.bench.environment.log_records_max = 2;
  b.plan_all(3);
  b.step();
  CHECK(b.job.progress().edits == 2);
  b.write_log();
  b.bench.edit(kRestorer, 1, kAtOrigin, 2);
  b.bench.server.commit(b.bench.now());
  b.write_log();
  for (int i = 0; i < 2; ++i) {  // the other chunk is written
    b.step();
    b.write_log();
  }
  CHECK(b.job.progress().edits == 5);
  CHECK(b.job.progress().collisions == 1);
  CHECK(b.job.progress().chunks_done == 1);
  const auto again = b.job.next_work(b.bench.server);
  REQUIRE(again.has_value());
  REQUIRE(again->items.size() == 1);
  CHECK(again->items[0].key == kHere);
  b.job.computed({b.planned(kHere, 1)});
  b.step();
  CHECK(b.job.state() == RestoreJob::State::done);
  CHECK(b.job.progress().voxels == 6);
  CHECK(b.job.progress().chunks_changed == 2);
}

TEST_CASE("a job with a payer writes as fast as the budget of the payer allows", "[rollback]") {
  WorldConfig slow = config();
  slow.edit_budget = {10, 4};
  JobBench b(1, slow);
  REQUIRE(b.author == 1);
  b.plan_all(5);
  b.step();
  CHECK(b.job.progress().edits == 4);
  CHECK(b.job.progress().waits_for.find("builder_budget") != std::string::npos);
  b.bench.edit(kRestorer, 1, kAtOrigin);  // nothing is left for a click
  REQUIRE(b.bench.environment.messages<Reject>(kRestorer, kEdge).size() == 1);
  CHECK(b.bench.environment.messages<Reject>(kRestorer, kEdge)[0].reason ==
        RejectReason::rate_limited);
  SECTION("the budget grows with time") {
    b.bench.tick(200'000);
    b.job.step(b.bench.server, b.bench.now());
    CHECK(b.job.progress().edits == 6);
  }
  SECTION("a second session of the author has no budget of its own") {
    b.bench.join(2, 1, 2);
    b.job.step(b.bench.server, b.bench.now());
    CHECK(b.job.progress().edits == 4);
  }
  SECTION("an author who has left pays as before") {
    b.bench.server.disconnected(kRestorer);
    b.job.step(b.bench.server, b.bench.now());
    CHECK(b.job.progress().edits == 4);
    b.bench.tick(200'000);
    b.job.step(b.bench.server, b.bench.now());
    CHECK(b.job.progress().edits == 6);
  }
}

TEST_CASE("an edit that costs more than the budget costs the whole budget", "[rollback]") {
  WorldConfig slow = config();
  slow.edit_budget = {10, 1};
  JobBench b(1, slow);
  REQUIRE(b.job.next_work(b.bench.server).has_value());
  RestoredChunk chunk = b.planned(kHere, 1);
  chunk.edits[0] = {Paste{{2, 2, 2}, one_cell(), {}}, {}, kEmpty};
  b.job.computed({chunk, b.planned(kThere, 1)});
  b.step();
  CHECK(b.job.progress().edits == 1);
  b.bench.tick(100'000);
  b.job.step(b.bench.server, b.bench.now());
  CHECK(b.job.state() == RestoreJob::State::done);
}

TEST_CASE("a client that takes a job's client sequences ends the job, not the server",
          "[rollback]") {
  JobBench b(1);
  b.bench.environment.log_records_max = 2;
  b.plan_all(2);
  b.step();
  REQUIRE(b.job.progress().edits == 2);
  b.write_log();
  b.bench.join(2, 1, kInstance);
  b.bench.edit(2, 1000, kAtOrigin);
  b.step();
  CHECK(b.job.state() == RestoreJob::State::failed);
  CHECK(b.job.progress().error.find("taken its client sequences") != std::string::npos);
  CHECK(b.job.progress().chunks_done == 1);
}

}  // namespace runstone::test
