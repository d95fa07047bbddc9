#include "client/schedule/latency_recorder.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

const ChunkKey kA{0, {0, 0, 0}};
const ChunkKey kB{0, {1, 0, 0}};
const OperationId kMine{5, 77, 1};
const OperationId kTheirs{6, 1, 1};

ChunkChange chunk(const ChunkKey& key, std::uint64_t serial) {
  ChunkChange change;
  change.key = key;
  change.serial = serial;
  return change;
}
ChunkChange removed(const ChunkKey& key) {
  ChunkChange change;
  change.key = key;
  change.removed = true;
  return change;
}
EditChange remote(std::vector<ChunkKey> chunks) {
  EditChange change;
  change.op = kTheirs;
  change.seq = 1;
  change.submitted_us = 10'000;  // server clock
  change.ordered_us = 10'100;
  change.received_us = 300;
  change.unpacked_us = 310;
  change.applied_us = 350;
  change.chunks = std::move(chunks);
  return change;
}
EditChange local(bool predicted, std::vector<ChunkKey> chunks, TimeUs applied) {
  EditChange change;
  change.op = kMine;
  change.is_local = true;
  change.predicted = predicted;
  change.ordered_us = 10'200;
  change.received_us = applied - 20;
  change.unpacked_us = applied - 10;
  change.applied_us = applied;
  change.chunks = std::move(chunks);
  return change;
}
ReplicaChanges changes(std::vector<ChunkChange> chunks, std::vector<EditChange> edits) {
  ReplicaChanges out;
  out.chunks = std::move(chunks);
  out.edits = std::move(edits);
  return out;
}
ClockOffset clock_ahead() {
  ClockOffset clock;
  clock.add(0, 9'900, 0);  // the server's clock is 9900 ahead, exactly
  return clock;
}
std::int64_t only(const Histogram& histogram) {
  REQUIRE(histogram.count() == 1);
  return *histogram.max();
}
const Histogram& since(const LatencyReport& report, EditPath path, LatencyStage stage) {
  return report[path].since_submit[static_cast<std::size_t>(stage)];
}
const Histogram& step(const LatencyReport& report, EditPath path, LatencyStage stage) {
  return report[path].step[static_cast<std::size_t>(stage)];
}

}  // namespace

TEST_CASE("a remote edit is timed through every stage, in this client's clock", "[schedule]") {
  LatencyRecorder recorder;
  recorder.take(changes({chunk(kA, 7)}, {remote({kA})}), clock_ahead(), 350);
  recorder.meshed(kA, 6, 380);  // of older runs, without the edit
  recorder.meshed(kA, 7, 400);
  recorder.uploaded(kA, 7, 420);
  CHECK(recorder.open_edits() == 1);
  recorder.presented(500);
  CHECK(recorder.open_edits() == 0);
  const LatencyReport report = recorder.report();
  const auto path = EditPath::remote;
  CHECK(only(since(report, path, LatencyStage::ordered)) == 100);
  CHECK(only(since(report, path, LatencyStage::received)) == 200);
  CHECK(only(since(report, path, LatencyStage::unpacked)) == 210);
  CHECK(only(since(report, path, LatencyStage::applied)) == 250);
  CHECK(only(since(report, path, LatencyStage::meshed)) == 300);
  CHECK(only(since(report, path, LatencyStage::uploaded)) == 320);
  CHECK(only(since(report, path, LatencyStage::presented)) == 400);
  CHECK(only(step(report, path, LatencyStage::meshed)) == 50);
  CHECK(report[path].edits == 1);
}

TEST_CASE("an edit passes a stage when the last of its chunks does", "[schedule]") {
  LatencyRecorder recorder;
  recorder.take(changes({chunk(kA, 1), chunk(kB, 2)}, {remote({kA, kB})}), clock_ahead(), 350);
  recorder.meshed(kA, 1, 400);
  recorder.uploaded(kA, 1, 410);
  recorder.presented(420);
  CHECK(recorder.open_edits() == 1);
  recorder.meshed(kB, 2, 600);
  recorder.uploaded(kB, 2, 610);
  recorder.presented(620);
  const LatencyReport report = recorder.report();
  CHECK(only(since(report, EditPath::remote, LatencyStage::meshed)) == 500);
  CHECK(only(since(report, EditPath::remote, LatencyStage::presented)) == 520);
}

TEST_CASE("the first mesh that contains a coalesced edit counts, not a later one", "[schedule]") {
  LatencyRecorder recorder;
  recorder.take(changes({chunk(kA, 3)}, {remote({kA})}), clock_ahead(), 350);
  recorder.meshed(kA, 5, 400);
  recorder.meshed(kA, 9, 500);
  recorder.uploaded(kA, 9, 510);
  recorder.presented(520);
  CHECK(only(since(recorder.report(), EditPath::remote, LatencyStage::meshed)) == 300);
}

TEST_CASE("a local edit counts from its scheduled time, as predicted and as confirmed",
          "[schedule]") {
  LatencyRecorder recorder;
  recorder.submitted(1, 1000);  // submitted at 1500, because the program was late
  recorder.take(changes({chunk(kA, 1)}, {local(true, {kA}, 1500)}), clock_ahead(), 1500);
  recorder.meshed(kA, 1, 1600);
  recorder.uploaded(kA, 1, 1610);
  recorder.presented(1700);
  recorder.take(changes({}, {local(false, {}, 3000)}), clock_ahead(), 3000);
  ReplicaChanges durable;
  durable.durable = {1};
  recorder.take(durable, clock_ahead(), 4000);
  const LatencyReport report = recorder.report();
  CHECK(only(since(report, EditPath::local_predicted, LatencyStage::applied)) == 500);
  CHECK(only(since(report, EditPath::local_predicted, LatencyStage::presented)) == 700);
  CHECK(since(report, EditPath::local_predicted, LatencyStage::received).count() == 0);
  CHECK(only(since(report, EditPath::local_confirmed, LatencyStage::applied)) == 2000);
  CHECK(since(report, EditPath::local_confirmed, LatencyStage::meshed).count() == 0);
  CHECK(only(report.durable) == 3000);
  CHECK(report[EditPath::remote].edits == 0);
}

TEST_CASE("an edit that was never seen is infinite in the stages that it did not reach",
          "[schedule]") {
  LatencyRecorder recorder;
  recorder.submitted(1, 1000);
  recorder.take(changes({chunk(kA, 1)}, {local(true, {kA}, 1100)}), clock_ahead(), 1100);
  recorder.not_submitted();
  const LatencyReport report = recorder.report();
  const auto& applied = since(report, EditPath::local_predicted, LatencyStage::applied);
  CHECK(applied.count() == 2);
  CHECK(applied.infinite() == 1);
  CHECK(since(report, EditPath::local_predicted, LatencyStage::presented).infinite() == 2);
  CHECK(since(report, EditPath::local_confirmed, LatencyStage::applied).infinite() == 2);
  CHECK(report.durable.infinite() == 1);
  CHECK(report[EditPath::local_predicted].edits == 2);
}

TEST_CASE("a rejected edit counts as rejected and in its prediction only", "[schedule]") {
  LatencyRecorder recorder;
  recorder.submitted(1, 1000);
  ReplicaChanges all = changes({chunk(kA, 1)}, {local(true, {kA}, 1100)});
  all.rejects.push_back({1, RejectReason::busy, ""});
  recorder.take(all, clock_ahead(), 1100);
  recorder.meshed(kA, 1, 1200);
  recorder.uploaded(kA, 1, 1200);
  recorder.presented(1300);
  const LatencyReport report = recorder.report();
  CHECK(report.rejected == 1);
  CHECK(report[EditPath::local_confirmed].edits == 0);
  CHECK(report.durable.count() == 0);
}

TEST_CASE("a local edit whose commit was missed is counted as unseen, not as late", "[schedule]") {
  LatencyRecorder recorder;
  recorder.submitted(1, 1000);
  ReplicaChanges all = changes({}, {local(true, {}, 1100)});
  all.unseen = {1};
  recorder.take(all, clock_ahead(), 1100);
  const LatencyReport report = recorder.report();
  CHECK(report.unseen == 1);
  CHECK(report[EditPath::local_confirmed].edits == 0);
  CHECK(report.durable.count() == 0);
}

TEST_CASE("edits without effect and edits that left the view are counted separately",
          "[schedule]") {
  LatencyRecorder recorder;
  recorder.take(changes({}, {remote({})}), clock_ahead(), 350);
  EditChange second = remote({kA});
  second.op.seq = 2;
  recorder.take(changes({chunk(kA, 1)}, {second}), clock_ahead(), 350);
  recorder.take(changes({removed(kA)}, {}), clock_ahead(), 360);
  const LatencyReport report = recorder.report();
  CHECK(report[EditPath::remote].edits == 2);
  CHECK(report[EditPath::remote].without_effect == 1);
  CHECK(report[EditPath::remote].left_view == 1);
  CHECK(since(report, EditPath::remote, LatencyStage::applied).count() == 2);
  CHECK(since(report, EditPath::remote, LatencyStage::presented).count() == 0);
}

TEST_CASE("a late part of an edit that was finished does not count again", "[schedule]") {
  LatencyRecorder recorder(LatencyStage::meshed);
  recorder.take(changes({chunk(kA, 1)}, {remote({kA})}), clock_ahead(), 350);
  recorder.meshed(kA, 1, 400);
  recorder.take(changes({chunk(kB, 2)}, {remote({kB})}), clock_ahead(), 900);
  recorder.meshed(kB, 2, 1000);
  const LatencyReport report = recorder.report();
  CHECK(report[EditPath::remote].edits == 1);
  CHECK(only(since(report, EditPath::remote, LatencyStage::meshed)) == 300);
}

TEST_CASE("without a clock offset only the steps from ordering on are known", "[schedule]") {
  LatencyRecorder recorder(LatencyStage::meshed);
  recorder.take(changes({chunk(kA, 1)}, {remote({kA})}), ClockOffset{}, 350);
  recorder.meshed(kA, 1, 400);
  const LatencyReport report = recorder.report();
  CHECK(report[EditPath::remote].unknown_submit == 1);
  CHECK(since(report, EditPath::remote, LatencyStage::meshed).count() == 0);
  CHECK(only(step(report, EditPath::remote, LatencyStage::meshed)) == 50);
}
