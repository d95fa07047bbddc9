#include "server/store/log_writer.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <semaphore>

#include "server/store/build_table.hpp"
#include "tests/support/sql/temp_place.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// A sink that records its calls. A test can hold it in the middle of a write.
class FakeSink final : public WorldSink {
 public:
  /// A part of the file of a build that was written; without bytes: the file was removed.
  struct FilePart {
    std::uint64_t content = 0;
    std::uint32_t part = 0;
    std::size_t bytes = 0;
    friend bool operator==(const FilePart&, const FilePart&) = default;
  };
  struct Commit {
    std::vector<PlayerRow> players;
    std::vector<EditRecord> records;
    std::size_t chunks = 0;
    std::optional<Sequence> checkpoint;
    std::optional<Keyframe> keyframe = {};
    std::vector<NameChange> names = {};
    FilePart file = {};
    std::optional<SavedState> state = {};
  };

  bool is_owned() const override { return owned.load(); }
  StoreResult<void> append(std::span<const PlayerRow> players,
                           std::span<const EditRecord> records) override {
    return commit({{players.begin(), players.end()}, {records.begin(), records.end()}, 0, {}});
  }
  StoreResult<void> change_names(std::span<const NameChange> changes) override {
    return commit({{}, {}, 0, {}, {}, {changes.begin(), changes.end()}});
  }
  StoreResult<void> save_snapshots(ChunkSpan chunks, std::optional<Sequence> checkpoint) override {
    return commit({{}, {}, chunks.size(), checkpoint});
  }
  StoreResult<void> commit(Commit commit) {
    entered.release();
    gate.acquire();
    if (fail_at == commits.size())
      return failure(StoreError{StoreError::Kind::io, "w", "", "disk broken"});
    commits.push_back(std::move(commit));
    return {};
  }
  std::atomic<bool> owned{true};
  /// Lets all writes pass from now on.
  void open_gate() { gate.release(1 << 20); }
  Sequence last() const {
    Sequence seq = 0;
    for (const Commit& c : commits) seq = c.records.empty() ? seq : c.records.back().version.seq;
    return seq;
  }

  StoreResult<void> save_keyframe(ChunkSpan chunks,
                                  const std::optional<Keyframe>& keyframe) override {
    if (refuse_keyframes)
      return failure(StoreError{StoreError::Kind::full, "w", "keyframe", "disk full"});
    return commit({{}, {}, chunks.size(), {}, keyframe});
  }
  StoreResult<void> save_state(const SavedState& state) override {
    Commit written;
    written.state = state;
    return commit(std::move(written));
  }
  StoreResult<void> save_tiles(ChunkSpan tiles, std::uint32_t /*rules*/) override {
    return commit({{}, {}, tiles.size(), {}});
  }
  StoreResult<void> save_build_part(std::uint64_t content, std::uint32_t part,
                                    ByteView data) override {
    Commit written;
    written.file = {content, part, data.size()};
    return commit(std::move(written));
  }
  StoreResult<void> remove_build_file(std::uint64_t content) override {
    Commit written;
    written.file = {content, 0, 0};
    return commit(std::move(written));
  }

  std::counting_semaphore<> entered{0}, gate{0};
  std::size_t fail_at = ~std::size_t{0};
  bool refuse_keyframes = false;
  std::vector<Commit> commits;  // read it after stop(), or while the writer waits at the gate
};

LogWriter::SnapshotChunks chunks(std::size_t count) {
  SplitMix64 rng(count);
  LogWriter::SnapshotChunks out;
  for (std::size_t i = 0; i < count; ++i) {
    out.emplace_back(ChunkKey{0, {static_cast<std::int32_t>(i), 0, 0}}, sample_chunk(rng, {1, 1}));
  }
  return out;
}

}  // namespace

TEST_CASE("queued records count with the memory that they take, until they are durable",
          "[store][log-writer]") {
  FakeSink sink;
  SplitMix64 rng(1);
  LogWriter writer(sink, {});
  CHECK(writer.queued_bytes() == 0);
  writer.append({}, sample_records(rng, 1, 1, 3));
  const std::size_t three = writer.queued_bytes();
  CHECK(three >= 3 * sizeof(EditRecord));
  sink.entered.acquire();  // being written is not yet written
  writer.append({}, sample_records(rng, 1, 4, 1));
  CHECK(writer.queued_bytes() > three);
  sink.open_gate();
  writer.stop();
  CHECK(writer.queued_bytes() == 0);
}

TEST_CASE("of several saved states the newest is written, after the records of its commit",
          "[store][log-writer]") {
  FakeSink sink;
  SplitMix64 rng(1);
  LogWriter writer(sink, {});
  writer.append({}, sample_records(rng, 1, 1, 1));
  sink.entered.acquire();  // being written
  const SavedState newest{{}, SavedClock{1, {5, 1}}};
  CHECK(writer.save_state({}));
  writer.append({}, sample_records(rng, 1, 2, 1));
  CHECK(writer.save_state(newest));
  sink.open_gate();
  writer.stop();
  REQUIRE(sink.commits.size() == 3);
  CHECK(sink.commits[1].records.size() == 1);
  CHECK(sink.commits[2].state == newest);
  CHECK(writer.counters().queued_records == 0);
  CHECK_FALSE(writer.save_state(newest));
  CHECK(writer.counters().queued_records == 0);
}

TEST_CASE("a state for which the queue has no room is not taken", "[store][log-writer]") {
  FakeSink sink;
  SplitMix64 rng(1);
  LogWriter::Limits limits;
  limits.queued_records_max = 2;
  LogWriter writer(sink, {}, limits);
  writer.append({}, sample_records(rng, 1, 1, 1));
  sink.entered.acquire();  // being written
  CHECK(writer.save_state({{}, SavedClock{1, {5, 1}}}));
  CHECK_FALSE(writer.save_state({{}, SavedClock{1, {6, 1}}}));
  sink.open_gate();
  writer.stop();
  REQUIRE(sink.commits.size() == 2);
  CHECK(sink.commits[1].state == SavedState{{}, SavedClock{1, {5, 1}}});
}

TEST_CASE("one file of a build is written at a time, in parts, and may be removed again",
          "[store][log-writer]") {
  FakeSink sink;
  SplitMix64 rng(1);
  std::atomic<int> done{0};
  const auto saved = [&](const StoreResult<void>& result) { done += result.has_value() ? 1 : 100; };
  const auto file = std::make_shared<const Bytes>(kBuildPartBytes + 5, std::uint8_t{1});
  LogWriter::Limits limits;
  limits.jobs_max = 1;
  LogWriter writer(sink, {}, limits);
  REQUIRE(writer.save_build_file(7, file, saved));
  sink.entered.acquire();  // the first part is being written
  CHECK_FALSE(writer.save_build_file(8, file, saved));
  writer.append({}, sample_records(rng, 1, 1, 1));
  writer.remove_build_file(7);
  // Jobs for files take no room from others.
  CHECK(writer.save_snapshots(chunks(1), std::nullopt));
  CHECK_FALSE(writer.save_snapshots(chunks(1), std::nullopt));
  sink.open_gate();
  writer.stop();
  CHECK(done == 1);
  REQUIRE(sink.commits.size() == 5);
  CHECK(sink.commits[0].file == FakeSink::FilePart{7, 0, kBuildPartBytes});
  CHECK(sink.commits[1].records.size() == 1);  // before the next part
  CHECK(sink.commits[2].file == FakeSink::FilePart{7, 1, 5});
  CHECK(sink.commits[3].file == FakeSink::FilePart{7, 0, 0});
  CHECK(sink.commits[4].chunks == 1);
}

TEST_CASE("everything that queued during one commit goes into the next", "[store][log-writer]") {
  FakeSink sink;
  SplitMix64 rng(1);
  std::vector<Sequence> durable;
  LogWriter writer(sink, {[&](Sequence seq) { durable.push_back(seq); }, {}, {}});
  writer.append({}, sample_records(rng, 1, 1, 1));
  sink.entered.acquire();  // the first commit is being written
  for (Sequence seq = 2; seq <= 10; ++seq)
    writer.append({sample_player(static_cast<AuthorId>(seq))}, sample_records(rng, 1, seq, 1));
  CHECK(writer.counters().queued_records == 10);
  sink.open_gate();
  writer.stop();
  REQUIRE(sink.commits.size() == 2);
  CHECK(sink.commits[0].records.size() == 1);
  CHECK(sink.commits[1].records.size() == 9);
  CHECK(sink.commits[1].players.size() == 9);
  CHECK(durable == std::vector<Sequence>{1, 10});
  CHECK(writer.counters().commits == 2);
  CHECK(writer.counters().records == 10);
  CHECK(writer.counters().queued_records == 0);
}

TEST_CASE("a group ends before its limit, and a batch is never divided", "[store][log-writer]") {
  FakeSink sink;
  SplitMix64 rng(2);
  LogWriter::Limits limits;
  limits.commit_records_max = 10;
  LogWriter writer(sink, {}, limits);
  writer.append({}, sample_records(rng, 1, 1, 1));
  sink.entered.acquire();
  writer.append({}, sample_records(rng, 1, 2, 6));
  writer.append({}, sample_records(rng, 1, 8, 4));
  writer.append({}, sample_records(rng, 1, 12, 25));
  writer.append({}, sample_records(rng, 1, 37, 1));
  sink.open_gate();
  writer.stop();
  std::vector<std::size_t> sizes;
  for (const auto& commit : sink.commits) sizes.push_back(commit.records.size());
  CHECK(sizes == std::vector<std::size_t>{1, 10, 25, 1});
}

TEST_CASE("a full queue has no room until a commit is done", "[store][log-writer]") {
  FakeSink sink;
  SplitMix64 rng(3);
  LogWriter::Limits limits;
  limits.queued_records_max = 8;
  std::counting_semaphore<> durable{0};
  LogWriter writer(sink, {[&](Sequence) { durable.release(); }, {}, {}}, limits);
  CHECK(writer.has_room(8));
  CHECK_FALSE(writer.has_room(9));
  writer.append({}, sample_records(rng, 1, 1, 3));
  sink.entered.acquire();
  CHECK(writer.has_room(5));  // the batch that is being written still takes room
  CHECK_FALSE(writer.has_room(6));
  writer.append({}, sample_records(rng, 1, 4, 5));
  CHECK(writer.has_room(0));
  CHECK_FALSE(writer.has_room(1));
  sink.gate.release();
  durable.acquire();
  CHECK(writer.has_room(3));
  CHECK_FALSE(writer.has_room(4));
  sink.open_gate();
  durable.acquire();
  CHECK(writer.has_room(8));
  writer.stop();
  CHECK_FALSE(writer.has_room(1));
  CHECK(sink.last() == 8);
}

TEST_CASE("while another program may own the world there is no room, and what is queued is written",
          "[store][log-writer]") {
  FakeSink sink;
  SplitMix64 rng(3);
  LogWriter writer(sink, {});
  writer.append({}, sample_records(rng, 1, 1, 3));
  sink.owned = false;
  CHECK_FALSE(writer.has_room(1));
  sink.owned = true;
  CHECK(writer.has_room(1));
  sink.owned = false;
  sink.open_gate();
  writer.stop();
  CHECK(sink.last() == 3);
}

TEST_CASE("players without records are written, and take the room of one record until then",
          "[store][log-writer]") {
  FakeSink sink;
  LogWriter::Limits limits;
  limits.queued_records_max = 2;
  LogWriter writer(sink, {}, limits);
  writer.append({}, {});  // an empty batch takes no room and makes no commit
  CHECK(writer.has_room(2));
  writer.append({sample_player(1), sample_player(2)}, {});
  sink.entered.acquire();
  CHECK(writer.has_room(1));
  writer.append({sample_player(3)}, {});
  CHECK_FALSE(writer.has_room(1));
  sink.open_gate();
  sink.entered.acquire();  // the second commit has begun, so the room of the first one is free
  CHECK(writer.has_room(1));
  writer.stop();
  REQUIRE(sink.commits.size() == 2);
  CHECK(sink.commits[0].players.size() == 2);
  CHECK(sink.commits[1].players.size() == 1);
  CHECK(writer.counters().queued_records == 0);
}

TEST_CASE("records overtake the slices of a large snapshot job", "[store][log-writer]") {
  FakeSink sink;
  SplitMix64 rng(4);
  LogWriter::Limits limits;
  limits.slice_chunks_max = 4;
  std::size_t saved = 0;
  std::optional<Sequence> checkpoint;
  LogWriter writer(sink,
                   {{},
                    [&](LogWriter::SnapshotChunks job, std::optional<Sequence> upto) {
                      saved += job.size();
                      checkpoint = upto;
                    },
                    {}},
                   limits);
  REQUIRE(writer.save_snapshots(chunks(10), 77));
  sink.entered.acquire();  // the writer is in the first slice
  writer.append({}, sample_records(rng, 1, 1, 2));
  sink.open_gate();
  writer.stop();
  REQUIRE(sink.commits.size() == 4);
  CHECK(sink.commits[0].chunks == 4);
  CHECK(sink.commits[1].records.size() == 2);
  CHECK(sink.commits[2].chunks == 4);
  CHECK(sink.commits[3].chunks == 2);
  CHECK_FALSE(sink.commits[0].checkpoint.has_value());  // the last slice moves the checkpoint
  CHECK_FALSE(sink.commits[2].checkpoint.has_value());
  CHECK(sink.commits[3].checkpoint == Sequence{77});
  CHECK(saved == 10);
  CHECK(checkpoint == Sequence{77});
  CHECK(writer.counters().snapshots == 10);
}

TEST_CASE("a snapshot job that finds the queue full is refused and takes nothing",
          "[store][log-writer]") {
  FakeSink sink;
  LogWriter::Limits limits;
  limits.jobs_max = 2;
  std::vector<std::size_t> saved;
  LogWriter writer(
      sink, {{}, [&](LogWriter::SnapshotChunks job, auto) { saved.push_back(job.size()); }, {}},
      limits);
  REQUIRE(writer.save_snapshots(chunks(1), {}));
  sink.entered.acquire();
  CHECK(writer.save_snapshots({}, 5));  // a job without chunks moves only the checkpoint
  CHECK_FALSE(writer.save_snapshots(chunks(3), {}));
  sink.open_gate();
  writer.stop();
  CHECK(saved == std::vector<std::size_t>{1, 0});
  REQUIRE(sink.commits.size() == 2);
  CHECK(sink.commits[1].checkpoint == Sequence{5});
}

TEST_CASE("after a failure nothing more is written or acknowledged", "[store][log-writer]") {
  FakeSink sink;
  sink.fail_at = 1;
  SplitMix64 rng(5);
  std::vector<Sequence> durable;
  std::vector<std::string> failures;
  std::counting_semaphore<> failed{0};
  LogWriter writer(sink, {[&](Sequence seq) { durable.push_back(seq); },
                          {},
                          [&](StoreError error) {
                            failures.push_back(error.message());
                            failed.release();
                          }});
  writer.append({}, sample_records(rng, 1, 1, 2));
  sink.entered.acquire();
  writer.append({}, sample_records(rng, 1, 3, 2));
  REQUIRE(writer.save_snapshots(chunks(2), {}));
  sink.open_gate();
  failed.acquire();
  CHECK_FALSE(writer.has_room(0));
  writer.append({}, sample_records(rng, 1, 5, 2));  // the writer drops it: it is never acknowledged
  CHECK_FALSE(writer.save_snapshots(chunks(1), {}));
  writer.stop();
  CHECK(sink.commits.size() == 1);
  CHECK(durable == std::vector<Sequence>{2});
  CHECK(failures == std::vector<std::string>{"w: disk broken"});
}

TEST_CASE("a keyframe is written with the last slice of its chunks, after records",
          "[store][log-writer]") {
  FakeSink sink;
  SplitMix64 rng(7);
  LogWriter::Limits limits;
  limits.slice_chunks_max = 4;
  LogWriter writer(sink, {}, limits);
  std::vector<bool> done;
  const Keyframe keyframe{{{1, 2}, 3}, 10, {}};
  REQUIRE(writer.save_keyframe(
      chunks(6), keyframe, [&](StoreResult<void> result) { done.push_back(result.has_value()); }));
  sink.entered.acquire();
  writer.append({}, sample_records(rng, 1, 1, 2));
  CHECK(done.empty());
  sink.open_gate();
  writer.stop();
  REQUIRE(sink.commits.size() == 3);
  CHECK(sink.commits[0].chunks == 4);
  CHECK_FALSE(sink.commits[0].keyframe.has_value());
  CHECK(sink.commits[1].records.size() == 2);
  CHECK(sink.commits[2].chunks == 2);
  CHECK(sink.commits[2].keyframe == keyframe);
  CHECK(done == std::vector<bool>{true});
  CHECK(writer.counters().keyframes == 1);
  CHECK(writer.counters().snapshots == 0);
}

TEST_CASE("a keyframe that cannot be written ends its job and nothing else",
          "[store][log-writer]") {
  FakeSink sink;
  sink.refuse_keyframes = true;
  sink.open_gate();
  SplitMix64 rng(8);
  LogWriter::Limits limits;
  limits.slice_chunks_max = 1;
  bool failed = false;
  std::vector<std::string> done;
  LogWriter writer(sink, {{}, {}, [&](StoreError) { failed = true; }}, limits);
  REQUIRE(writer.save_keyframe(chunks(3), Keyframe{}, [&](StoreResult<void> result) {
    done.push_back(result.error().message());
  }));
  writer.append({}, sample_records(rng, 1, 1, 2));
  REQUIRE(writer.save_snapshots(chunks(1), {}));
  writer.stop();
  CHECK(done == std::vector<std::string>{"w: keyframe: disk full"});
  CHECK_FALSE(failed);
  CHECK(sink.last() == 2);
  CHECK(writer.counters().snapshots == 1);
  CHECK(writer.counters().keyframes == 0);
}

TEST_CASE("a failure of the writer ends the jobs for keyframes with an error",
          "[store][log-writer]") {
  FakeSink sink;
  sink.fail_at = 1;
  SplitMix64 rng(9);
  LogWriter::Limits limits;
  limits.slice_chunks_max = 1;
  std::vector<std::string> done;
  const auto tell = [&](StoreResult<void> result) {
    done.push_back(result ? "fine" : result.error().message());
  };
  LogWriter writer(sink, {}, limits);
  REQUIRE(writer.save_keyframe(chunks(3), Keyframe{}, tell));
  sink.entered.acquire();  // the writer is in the first slice, which succeeds
  REQUIRE(writer.save_keyframe(chunks(1), Keyframe{}, tell));
  writer.append({}, sample_records(rng, 1, 1, 2));  // fails
  sink.open_gate();
  writer.stop();
  CHECK(done == std::vector<std::string>{"w: disk broken", "w: disk broken"});
  CHECK_FALSE(writer.save_keyframe(chunks(1), Keyframe{}, tell));
}

TEST_CASE("batches from another thread arrive on disk in order", "[store][log-writer]") {
  TempPlace place;
  auto store = *create_world(place.path(), sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  SplitMix64 rng(6);
  const auto records = sample_records(rng, 1, 1, 3000);
  std::atomic<Sequence> durable{0};
  std::uint64_t backwards = 0, waits = 0;
  {
    LogWriter::Limits limits;
    limits.queued_records_max = 64;
    limits.commit_records_max = 32;
    LogWriter writer(
        *store, {[&](Sequence seq) { backwards += seq <= durable.exchange(seq) ? 1 : 0; }, {}, {}},
        limits);
    for (std::size_t at = 0; at < records.size();) {
      const std::size_t count = std::min<std::size_t>(1 + rng.below(9), records.size() - at);
      while (!writer.has_room(count)) {
        ++waits;
        std::this_thread::yield();
      }
      writer.append({}, {records.begin() + static_cast<std::ptrdiff_t>(at),
                         records.begin() + static_cast<std::ptrdiff_t>(at + count)});
      at += count;
    }
  }  // the destructor drains
  CHECK(durable == 3000);
  CHECK(backwards == 0);
  CHECK(waits > 0);
  std::vector<EditRecord> read;
  REQUIRE(store
              ->read_log(1, 3000,
                         [&](const EditRecord& record) {
                           read.push_back(record);
                           return true;
                         })
              .has_value());
  CHECK(read == records);
}
