// One server and several replicas in virtual time: overlapping edits; links that delay, split,
// stall and cut the stream; a server that loses power with edits that are not on disk. Afterwards
// all must have the same voxels, and the log must have each durable edit exactly once. The final
// check shares no code with the code under test: the dense per-voxel oracle replays the log.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <sstream>
#include <vector>

#include "server/store/sqlite_backend.hpp"
#include "tests/simulation/client/session/final_check.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/power_loss_vfs.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

class Simulation {
 public:
  /// `readers` further clients only view, cache chunks on disk, and are killed and restarted.
  explicit Simulation(std::uint64_t seed, unsigned replicas = 3, bool synchronous = true,
                      unsigned readers = 0)
      : rng_(seed),
        readers_(readers),
        options_{vfs_.name(), synchronous},
        server_(time_, rng_, world_config(), [this] { return open(); }) {
    WorldMeta meta = sample_meta();
    meta.chunk_edge = kSimEdge;
    REQUIRE(create_sqlite_world(folder_.path(), meta, options_).has_value());
    server_.start();
    for (unsigned i = 0; i < replicas; ++i) {
      clients_.push_back(std::make_unique<SimClient>(time_, rng_, dial(), i + 1));
    }
    for (unsigned i = 0; i < readers; ++i) {
      clients_.push_back(std::make_unique<SimClient>(time_, rng_, dial(), 100 + i,
                                                     folder_ / ("cache" + std::to_string(i))));
    }
  }

  /// Performs `steps` random actions, and then waits until nothing is in flight.
  void run(int steps, std::uint32_t crashes_per_1000) {
    for (int step = 0; step < steps; ++step) {
      time_.run_until(time_.now() + rng_.between(200, 12'000));
      act();
      if (server_.running() && rng_.below(1000) < crashes_per_1000) crash();
    }
    faults_.stalls_per_1000 = 0;
    server_.drop_commits = 0;
    come_to_rest();
    if (server_.dropped == 0) return;
    // A lost commit that no other edit follows is found by the next digest check of its chunk.
    time_.run_until(time_.now() + kDigestCheckRoundUs);
    come_to_rest();
  }

  FinalCheck check() {
    FinalCheck r;
    std::vector<EditRecord> log;
    const Sequence last = server_.world().order().head();
    if (last > 0) {
      const auto read = server_.store().read_log(1, last, [&](const EditRecord& record) {
        log.push_back(record);
        return true;
      });
      r.expect(read.has_value(), read ? "" : read.error().message());
    }
    r.edits = log.size();
    r.expect(log.size() == last, "the log ends before the server's last sequence");
    r.check_durable_kept(log, remembered_);
    r.check_exactly_once(log, clients_);
    r.check_voxels(log, {&server_.world()}, clients_);
    r.check_heights(log, world_config().heights, clients_);
    return r;
  }

  std::vector<std::unique_ptr<SimClient>>& clients() { return clients_; }
  SimServer& server() { return server_; }
  int crashes() const { return crashes_; }
  int cuts() const { return cuts_; }
  VirtualTime& time() { return time_; }

  std::string summary(const FinalCheck& r) const {
    std::ostringstream out;
    out << r.edits << " edits, " << r.chunks << " chunks, " << crashes_ << " crashes, " << cuts_
        << " cuts, " << r.rejected << " rejected, " << r.unknown
        << " never explained: all digests equal";
    return out.str();
  }

 private:
  /// Time in which all 145 chunks of the largest view are checked, at 8 a second.
  static constexpr TimeUs kDigestCheckRoundUs = 30'000'000;

  SimDial dial() {
    return [this](SimEnd client) {
      return server_.running() ? server_.accept(faults_, std::move(client)) : nullptr;
    };
  }

  void come_to_rest() {
    const TimeUs give_up = time_.now() + 300'000'000;
    do {
      time_.run_until(time_.now() + 1'000'000);
    } while (!at_rest() && time_.now() < give_up);
    if (!at_rest()) throw SimFault("the world does not come to rest");
  }

  static WorldConfig world_config() {
    WorldConfig config;
    config.chunk_edge = kSimEdge;
    config.heights = {-24, 30};  // random edits reach beyond both
    config.materials = default_material_table();
    config.server_keys = key_pair_of(KeySeed{7});
    // Many rounds, so that crashes fall between snapshots and checkpoints.
    config.snapshots.edits_max = 300;
    config.snapshots.interval_us = 3'000'000;
    config.snapshots.slice_chunks = 5;
    config.memory.idle_bytes_max = 20'000;  // so that chunks leave memory
    return config;
  }

  std::unique_ptr<Store> open() {
    auto store = open_sqlite_world(folder_.path(), StoreAccess::read_write, options_);
    if (!store) throw SimFault(store.error().message());
    return std::move(*store);
  }

  void act() {
    if (readers_ > 0 && rng_.below(10) == 0) {
      SimClient& reader = *clients_[clients_.size() - 1 - rng_.below(readers_)];
      const std::uint32_t what = rng_.below(12);
      if (what == 0) return reader.restart();
      if (what == 1) return reader.cut();
      if (what == 2) {
        return reader.look({1,
                            {rng_.between(-2, 2), 0, rng_.between(-2, 2)},
                            static_cast<std::uint8_t>(1 + rng_.below(3)),
                            1});
      }
    }
    SimClient& client =
        *clients_[rng_.below(static_cast<std::uint32_t>(clients_.size()) - readers_)];
    switch (rng_.below(100)) {
      case 0:
        client.cut();
        ++cuts_;
        break;
      case 1:
        // Sometimes views change so often that the server skips some, and sometimes more often than
        // it remembers.
        for (std::uint64_t looks = rng_.below(3) == 0 ? 2 + rng_.below(14) : 1; looks > 0;
             --looks) {
          client.look({1,
                       {rng_.between(-1, 1), rng_.between(-1, 1), rng_.between(-1, 1)},
                       static_cast<std::uint8_t>(1 + rng_.below(3)),
                       static_cast<std::uint8_t>(rng_.below(3))});
        }
        break;
      case 2: {
        // An unknown material: the edit must be rejected.
        EditDescriptor bad{SetVoxel{{0, 0, 0}}, {}, 60'000};
        client.edit(bad);
        break;
      }
      case 3:
        server_.log_full = rng_.below(2) == 0;
        break;
      default: {
        EditDescriptor edit = random_edit_near(rng_, {-8, -8, -8}, Extent::cube(kSimEdge));
        client.edit(edit);
      }
    }
  }

  void crash() {
    const Sequence durable = server_.world().order().durable();
    if (durable > 0) {
      remembered_.clear();
      const auto read = server_.store().read_log(1, durable, [&](const EditRecord& record) {
        remembered_.push_back(record.op);
        return true;
      });
      if (!read) throw SimFault(read.error().message());
    }
    vfs_.power_loss(rng_);  // before the store is closed, because closing writes
    server_.crash();
    server_.log_full = false;
    ++crashes_;
    time_.after(rng_.between(1000, 300'000), [this] { server_.start(); });
  }

  bool at_rest() {
    server_.log_full = false;
    if (!server_.running() || server_.world().order().durable() != server_.world().order().head())
      return false;
    return std::all_of(clients_.begin(), clients_.end(),
                       [](const auto& c) { return c->is_idle(); });
  }

  VirtualTime time_;
  SplitMix64 rng_;
  const unsigned readers_;
  LinkFaults faults_;
  TempFolder folder_;
  PowerLossVfs vfs_;
  SqliteOptions options_;
  SimServer server_;
  std::vector<std::unique_ptr<SimClient>> clients_;
  std::vector<OperationId> remembered_;  // durable at the last crash
  int crashes_ = 0, cuts_ = 0;
};

}  // namespace

void three_replicas(std::uint64_t seed) {
  CAPTURE(seed);
  Simulation simulation(seed);
  simulation.run(2500, 4);
  const FinalCheck r = simulation.check();
  INFO(r.text());
  CHECK(r.faults.empty());
  CHECK(simulation.crashes() > 2);
  CHECK(simulation.cuts() > 5);
  CHECK(r.rejected > 0);
  CHECK(r.beyond > 50);
  for (const auto& client : simulation.clients()) CHECK(client->replica().counters().drifted == 0);
  std::uint64_t same = 0, updates = 0;
  for (const auto& client : simulation.clients()) {
    same += client->replica().counters().same_taken;
    updates += client->replica().counters().updates_taken;
  }
  CHECK(same > 20);
  CHECK(updates > 0);
  WARN("seed " << seed << ": 2500 steps, " << simulation.summary(r) << ", " << same
               << " chunks held as they were, " << updates << " brought up to date by edits");
}

TEST_CASE("three replicas and a server that loses power agree after thousands of steps",
          "[simulation]") {
  three_replicas(static_cast<std::uint64_t>(GENERATE(1, 2)));
}

TEST_CASE("three replicas and a server that loses power agree with more seeds", "[.long]") {
  three_replicas(static_cast<std::uint64_t>(GENERATE(3, 4, 5, 6)));
}

void ten_replicas(std::uint64_t seed, int steps) {
  CAPTURE(seed);
  Simulation simulation(seed, 10);
  simulation.server().drop_commits = 2;
  simulation.run(steps, 2);
  const FinalCheck r = simulation.check();
  INFO(r.text());
  CHECK(r.faults.empty());
  // The seed decides how much went wrong: any of it, so that the other checks mean something.
  CHECK(simulation.crashes() > 1);
  CHECK(simulation.cuts() > 5);
  CHECK(simulation.server().dropped > 1);
  WARN("seed " << seed << ": ten replicas, " << steps << " steps, " << simulation.summary(r) << ", "
               << simulation.server().dropped << " commits lost on the way");
}

TEST_CASE("ten replicas agree after cut links, lost commits and power failures", "[simulation]") {
  ten_replicas(7, 3'000);
}

// Minutes: docs/testing.md gives the command.
TEST_CASE("ten replicas agree after tens of thousands of steps", "[.long]") {
  ten_replicas(static_cast<std::uint64_t>(GENERATE(2026, 2027)), 20'000);
}

void killed_clients(std::uint64_t seed) {
  CAPTURE(seed);
  Simulation simulation(seed, 3, true, 3);
  simulation.run(2500, 4);
  const FinalCheck r = simulation.check();
  INFO(r.text());
  CHECK(r.faults.empty());
  CHECK(simulation.crashes() > 2);
  std::uint64_t hits = 0, not_common = 0;
  for (const auto& client : simulation.clients()) {
    CHECK(client->replica().counters().drifted == 0);
    CHECK(client->replica().counters().claims_refuted == 0);
    if (client->cache() == nullptr) continue;
    hits += client->cache()->counters().hits;
    not_common += client->cache()->counters().not_common;
    CHECK(client->cache()->counters().corrupt == 0);
  }
  CHECK(hits > 100);
  WARN("seed " << seed << ": " << hits << " chunks from caches, " << not_common
               << " dropped there after crashes, " << simulation.server().updates
               << " brought up to date by edits");
}

TEST_CASE("clients that are killed restart with their caches, and no replica drifts",
          "[simulation]") {
  killed_clients(21);
}

TEST_CASE("clients that are killed restart with their caches, with more seeds", "[.long]") {
  killed_clients(static_cast<std::uint64_t>(GENERATE(22, 23, 24)));
}

TEST_CASE("commits that vanish between server and replica are noticed and repaired",
          "[simulation]") {
  Simulation simulation(11);
  simulation.server().drop_commits = 40;
  simulation.run(1500, 0);
  const FinalCheck r = simulation.check();
  INFO(r.text());
  CHECK(simulation.server().dropped > 5);
  CHECK(r.faults.empty());
}

TEST_CASE(
    "without synchronous writes the same simulation loses durable edits, "
    "and the final check finds it",
    "[simulation]") {
  bool caught = false;
  for (std::uint64_t seed = 1; seed <= 5 && !caught; ++seed) {
    try {
      Simulation simulation(seed, 3, false);
      simulation.run(1500, 8);
      caught = !simulation.check().faults.empty();
    } catch (const SimFault&) {
      caught = true;  // the torn database does not open
    }
  }
  CHECK(caught);
}

}  // namespace runstone::test
