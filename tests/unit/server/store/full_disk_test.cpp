// A disk without space: the log writer keeps what it cannot write, and the store accepts the same
// records when there is space again.
#include <atomic>
#include <catch2/catch.hpp>
#include <mutex>
#include <semaphore>

#include "server/store/log_writer.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/power_loss_vfs.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

using namespace std::chrono_literals;

/// A world that finds no room while `is_full`.
class FillingSink final : public WorldSink {
 public:
  StoreResult<void> append(std::span<const PlayerRow> /*players*/,
                           std::span<const EditRecord> records) override {
    if (is_full) return no_room();
    for (const EditRecord& record : records) written.push_back(record.version.seq);
    return {};
  }
  StoreResult<void> change_names(std::span<const NameChange> changes) override {
    if (is_full) return no_room();
    names += changes.size();
    return {};
  }
  StoreResult<void> save_state(const SavedState& /*state*/) override {
    if (is_full) return no_room();
    ++states;
    return {};
  }
  StoreResult<void> save_snapshots(ChunkSpan /*chunks*/,
                                   std::optional<Sequence> /*checkpoint*/) override {
    return is_full || is_full_for_snapshots ? no_room() : StoreResult<void>{};
  }
  StoreResult<void> save_keyframe(ChunkSpan /*chunks*/,
                                  const std::optional<Keyframe>& /*keyframe*/) override {
    return is_full ? no_room() : StoreResult<void>{};
  }
  StoreResult<void> save_tiles(ChunkSpan /*tiles*/, std::uint32_t /*rules*/) override {
    return is_full ? no_room() : StoreResult<void>{};
  }

  std::atomic<bool> is_full{false}, is_full_for_snapshots{false};
  std::vector<Sequence> written;      // read it after stop()
  std::size_t names = 0, states = 0;  // writes; read them after stop()

 private:
  static StoreResult<void> no_room() {
    return failure(StoreError{StoreError::Kind::full, "w", "", "disk full"});
  }
};

/// A log writer over a FillingSink. The events are counted.
struct SpaceBench {
  /// The default is a look at each turn.
  explicit SpaceBench(std::uint64_t reserve_bytes = 0, std::chrono::milliseconds interval = 0ms) {
    LogWriter::Callbacks callbacks;
    callbacks.on_durable = [this](Sequence seq) { durable = seq; };
    callbacks.on_snapshots_saved = [this](auto, auto) { saved.release(); };
    callbacks.on_failed = [this](const StoreError&) { has_failed = true; };
    callbacks.on_space = [this](DiskSpace space, const std::string& reason) {
      const std::lock_guard guard(mutex);
      reasons.push_back(reason);
      seen(space).release();
    };
    callbacks.free_bytes = [this] { return std::optional<std::uint64_t>(free); };
    LogWriter::Limits limits;
    limits.reserve_bytes = reserve_bytes;
    limits.space_interval = interval;
    limits.commit_records_max = 4;
    writer.emplace(sink, std::move(callbacks), limits);
  }
  std::counting_semaphore<>& seen(DiskSpace space) {
    return space == DiskSpace::full ? full : space == DiskSpace::low ? low : enough;
  }
  void append(Sequence first, std::size_t count) {
    writer->append({}, sample_records(rng, 1, first, count));
  }

  SplitMix64 rng{1};
  FillingSink sink;
  std::atomic<std::uint64_t> free{1 << 20};
  std::atomic<Sequence> durable{0};
  std::atomic<bool> has_failed{false};
  std::counting_semaphore<> saved{0}, full{0}, low{0}, enough{0};
  std::mutex mutex;
  std::vector<std::string> reasons;
  std::optional<LogWriter> writer;
};

std::vector<Sequence> sequences(Sequence last) {
  std::vector<Sequence> all;
  for (Sequence seq = 1; seq <= last; ++seq) all.push_back(seq);
  return all;
}

}  // namespace

TEST_CASE("a full disk keeps every queued record, and writing goes on when there is space",
          "[store][log-writer][sqlite]") {
  SpaceBench bench;
  bench.append(1, 2);
  bench.sink.is_full = true;
  bench.append(3, 2);
  bench.full.acquire();
  CHECK_FALSE(bench.writer->has_room(1));
  CHECK(bench.writer->has_queue_room(3));
  bench.append(5, 3);  // the world ordered these before it knew, or they must not wait
  CHECK(bench.writer->counters().queued_records >= 5);
  CHECK(bench.durable <= 2);
  bench.sink.is_full = false;
  bench.enough.acquire();
  CHECK(bench.writer->has_room(1));
  bench.append(8, 1);
  bench.writer->stop();
  CHECK(bench.sink.written == sequences(8));
  CHECK(bench.durable == 8);
  CHECK_FALSE(bench.has_failed);
  CHECK(bench.reasons == std::vector<std::string>{"w: disk full", ""});
}

TEST_CASE("a saved state waits for space, and none is taken while the disk is full",
          "[store][log-writer][sqlite]") {
  SpaceBench bench;
  bench.sink.is_full = true;
  REQUIRE(bench.writer->save_state({}));
  bench.full.acquire();
  CHECK_FALSE(bench.writer->save_state({}));
  bench.sink.is_full = false;
  bench.enough.acquire();
  CHECK(bench.writer->save_state({}));
  bench.writer->stop();
  CHECK(bench.sink.states == 2);
  CHECK(bench.writer->counters().queued_records == 0);
  CHECK_FALSE(bench.has_failed);
}

TEST_CASE("a stop on a full disk gives up and says how many records are lost",
          "[store][log-writer][sqlite]") {
  SpaceBench bench;
  bench.sink.is_full = true;
  bench.append(1, 3);
  bench.full.acquire();
  REQUIRE(bench.writer->save_snapshots({}, Sequence{1}));
  bench.writer->stop();
  CHECK(bench.writer->counters().queued_records == 3);
  CHECK(bench.durable == 0);
  CHECK_FALSE(bench.has_failed);
}

TEST_CASE("a stop writes all records although the snapshots before them have no room",
          "[store][log-writer][sqlite]") {
  SpaceBench bench(0, 1h);
  bench.sink.is_full_for_snapshots = true;
  REQUIRE(bench.writer->save_snapshots({}, Sequence{1}));
  bench.full.acquire();
  for (Sequence first = 1; first < 13; first += 4) bench.append(first, 4);
  bench.writer->stop();
  CHECK(bench.sink.written == sequences(12));
  CHECK(bench.writer->counters().queued_records == 0);
}

TEST_CASE("snapshots wait for space, and keyframes end with an error",
          "[store][log-writer][sqlite]") {
  SpaceBench bench;
  bench.sink.is_full = true;
  REQUIRE(bench.writer->save_snapshots({}, Sequence{1}));
  bench.full.acquire();
  std::counting_semaphore<> done{0};
  std::string what;
  REQUIRE(bench.writer->save_keyframe({}, Keyframe{}, [&](const StoreResult<void>& result) {
    what = result ? "written" : result.error().message();
    done.release();
  }));
  done.acquire();
  CHECK(what == "w: disk full");
  bench.sink.is_full = false;
  bench.saved.acquire();
  bench.writer->stop();
  CHECK_FALSE(bench.has_failed);
}

TEST_CASE("below the reserve there is no room for new records, and queued ones are written",
          "[store][log-writer][sqlite]") {
  SpaceBench bench(2 << 20);       // one MiB is free
  CHECK(bench.low.try_acquire());  // known before the constructor returns
  CHECK_FALSE(bench.writer->has_room(1));
  bench.append(1, 2);
  REQUIRE(bench.writer->save_snapshots({}, Sequence{1}));
  bench.saved.acquire();
  CHECK_FALSE(bench.writer->has_room(1));
  bench.free = 3 << 20;
  bench.enough.acquire();
  CHECK(bench.writer->has_room(1));
  bench.free = 0;
  bench.append(3, 1);
  bench.low.acquire();
  CHECK_FALSE(bench.writer->has_room(1));
  bench.writer->stop();
  CHECK(bench.sink.written == sequences(3));
  REQUIRE(bench.reasons.size() == 3);
  CHECK(bench.reasons[0] == "the world's disk has 1 MiB free, and its reserve is 2 MiB");
}

TEST_CASE("a store that found the disk full at any operation accepts the same records again",
          "[store][sqlite]") {
  std::size_t refused = 0;
  for (std::uint64_t room = 0; room < 40; ++room) {
    CAPTURE(room);
    const TempFolder folder;
    PowerLossVfs vfs;
    SplitMix64 rng(7);
    auto store = *create_sqlite_world(folder.path(), sample_meta(), {vfs.name(), true});
    REQUIRE(store->raise_epoch().has_value());
    const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
    const auto records = sample_records(rng, 1, 1, 80);
    const std::span all(records);
    REQUIRE(store->append(players, all.first(40)).has_value());
    vfs.full_after(room);
    const auto first = store->append({}, all.subspan(40, 20));
    if (!first) {
      CHECK(first.error().kind == StoreError::Kind::full);
      ++refused;
      CHECK(*store->last_sequence() == 40);
      vfs.make_room();
      const auto again = store->append({}, all.subspan(40, 20));
      CHECK((again ? "" : again.error().message()) == "");
    }
    vfs.make_room();
    CHECK(store->append({}, all.subspan(60)).has_value());
    std::vector<EditRecord> read;
    REQUIRE(store->read_log(1, 80, [&](const EditRecord& record) {
      read.push_back(record);
      return true;
    }));
    CHECK(read == records);
    const auto checked = store->check();
    CHECK((checked ? "" : checked.error().message()) == "");
  }
  CHECK(refused > 3);
}

}  // namespace runstone::test
