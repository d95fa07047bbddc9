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

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/simulation/client/session/sim_client.hpp"
#include "tests/simulation/client/session/sim_server.hpp"
#include "tests/support/edit_oracle.hpp"
#include "tests/support/power_loss_vfs.hpp"
#include "tests/support/sample_world.hpp"
#include "tests/support/temp_folder.hpp"

namespace runstone::test {
namespace {

/// The result of the final check. Each fault is one line.
struct FinalCheck {
  std::vector<std::string> faults;
  std::uint64_t edits = 0, chunks = 0, rejected = 0;
  std::uint64_t beyond = 0;   // refused by the clients: outside of the world's heights
  std::uint64_t unknown = 0;  // rejected by a server that died before it could answer: unseen
  void expect(bool ok, const std::string& fault) {
    if (!ok) faults.push_back(fault);
  }
};

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
      clients_.push_back(std::make_unique<SimClient>(time_, rng_, server_, faults_, i + 1));
    }
    for (unsigned i = 0; i < readers; ++i) {
      clients_.push_back(std::make_unique<SimClient>(time_, rng_, server_, faults_, 100 + i,
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
    const Sequence last = server_.world().head();
    if (last > 0) {
      const auto read = server_.store().read_log(1, last, [&](const EditRecord& record) {
        log.push_back(record);
        return true;
      });
      r.expect(read.has_value(), read ? "" : read.error().message());
    }
    r.edits = log.size();
    r.expect(log.size() == last, "the log ends before the server's last sequence");
    check_durable_kept(log, r);
    check_exactly_once(log, r);
    check_voxels(log, r);
    check_heights(log, r);
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
    const Sequence durable = server_.world().durable();
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
    if (!server_.running() || server_.world().durable() != server_.world().head()) return false;
    return std::all_of(clients_.begin(), clients_.end(),
                       [](const auto& c) { return c->is_idle(); });
  }

  /// Checks that edits durable before a crash are in the log, at the same sequence.
  void check_durable_kept(const std::vector<EditRecord>& log, FinalCheck& r) const {
    r.expect(log.size() >= remembered_.size(), "durable edits are missing");
    for (std::size_t i = 0; i < std::min(log.size(), remembered_.size()); ++i) {
      r.expect(log[i].op == remembered_[i], "a durable edit changed, seq " + std::to_string(i + 1));
    }
  }

  /// Checks that each submitted edit is in the log once, or that its client knows why not.
  void check_exactly_once(const std::vector<EditRecord>& log, FinalCheck& r) const {
    std::map<OperationId, int> times;
    for (const EditRecord& record : log) ++times[record.op];
    for (const auto& [op, count] : times) r.expect(count == 1, "an edit was applied twice");
    for (const auto& client : clients_) {
      for (const auto& [seq, edit] : client->submitted()) {
        const auto found = times.find({client->session().author(), client->instance(), seq});
        const auto reject = client->rejected().find(seq);
        const bool is_rejected =
            reject != client->rejected().end() || client->unseen().contains(seq);
        r.unknown += client->unseen().contains(seq) && found == times.end() ? 1 : 0;
        r.rejected += is_rejected ? 1 : 0;
        r.expect(found != times.end() || is_rejected,
                 "an edit was lost without an answer, client seq " + std::to_string(seq));
        r.expect(found == times.end() || reject == client->rejected().end(),
                 "an edit was rejected and applied, client seq " + std::to_string(seq));
        r.expect(found != times.end() || !client->durable().contains(seq),
                 "an edit called durable is not in the log");
      }
    }
  }

  /// Checks that no edit beyond the world's heights was ordered, and that the clients refused all
  /// of them.
  void check_heights(const std::vector<EditRecord>& log, FinalCheck& r) const {
    const HeightLimits heights = world_config().heights;
    for (const EditRecord& record : log) {
      const VoxelBox box = bounding_box(record.edit);
      r.expect(box.min.y >= heights.y_min && box.max.y <= heights.y_max,
               "an edit beyond the heights is in the log");
    }
    for (const auto& client : clients_) {
      r.beyond += client->refused();
      for (const auto& [seq, reason] : client->rejected()) {
        r.expect(reason != RejectReason::outside_world,
                 "a client predicted an edit beyond the heights");
      }
    }
  }

  /// Checks that server, replicas and the dense replay of the log agree, chunk by chunk.
  void check_voxels(const std::vector<EditRecord>& log, FinalCheck& r) {
    std::map<ChunkKey, std::vector<EditDescriptor>> edits;
    std::map<ChunkKey, Sequence> versions;
    for (const EditRecord& record : log) {
      for (const ChunkCoord at : touched_chunks(record.edit, kSimEdge)) {
        edits[{0, at}].push_back(record.edit);
        versions[{0, at}] = record.version.seq;
      }
    }
    for (const auto& client : clients_) {
      for (const ChunkKey& key : client->replica().confirmed_keys()) edits.try_emplace(key);
    }
    for (const auto& [key, stack] : edits) {
      ++r.chunks;
      DenseChunk oracle = DenseChunk::of(sim_base_chunk(key.at));
      oracle_apply(oracle, origin_of(key.at, kSimEdge), stack);
      const Digest expected = oracle.digest();
      const std::string name = "chunk " + std::to_string(key.at.x) + "," +
                               std::to_string(key.at.y) + "," + std::to_string(key.at.z);
      if (const ChunkPtr live = server_.world().find_chunk(key)) {
        r.expect(digest_of(live->voxels) == expected, name + ": the server differs from the log");
        r.expect(live->digest == expected,
                 name + ": the server's digest does not follow its voxels");
      }
      for (const auto& client : clients_) {
        const ChunkPtr held = client->replica().confirmed(key);
        if (!held) continue;
        r.expect(digest_of(held->voxels) == expected, name + ": a replica differs from the log");
        r.expect(held->version.seq == versions[key],
                 name + ": a replica stands at another version");
        r.expect(*client->replica().shown(key) == held->voxels,
                 name + ": something is shown that nobody confirmed");
      }
    }
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

std::string joined(const std::vector<std::string>& lines) {
  std::string out;
  for (std::size_t i = 0; i < lines.size() && i < 10; ++i) out += lines[i] + "\n";
  return out;
}

}  // namespace

TEST_CASE("three replicas and a server that loses power agree after thousands of steps",
          "[simulation]") {
#ifdef RUNSTONE_SANITIZED
  const auto seed = static_cast<std::uint64_t>(GENERATE(1, 2));  // a minute each
#else
  const auto seed = static_cast<std::uint64_t>(GENERATE(1, 2, 3, 4));
#endif
  CAPTURE(seed);
  Simulation simulation(seed);
  simulation.run(2500, 4);
  const FinalCheck r = simulation.check();
  INFO(joined(r.faults));
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

void ten_replicas(std::uint64_t seed, int steps) {
  CAPTURE(seed);
  Simulation simulation(seed, 10);
  simulation.server().drop_commits = 2;
  simulation.run(steps, 2);
  const FinalCheck r = simulation.check();
  INFO(joined(r.faults));
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

TEST_CASE("clients that are killed restart with their caches, and no replica drifts",
          "[simulation]") {
  const auto seed = static_cast<std::uint64_t>(GENERATE(21, 22));
  CAPTURE(seed);
  Simulation simulation(seed, 3, true, 3);
  simulation.run(2500, 4);
  const FinalCheck r = simulation.check();
  INFO(joined(r.faults));
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

TEST_CASE("commits that vanish between server and replica are noticed and repaired",
          "[simulation]") {
  Simulation simulation(11);
  simulation.server().drop_commits = 40;
  simulation.run(1500, 0);
  const FinalCheck r = simulation.check();
  INFO(joined(r.faults));
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
