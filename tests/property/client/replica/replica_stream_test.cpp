// Random interleavings of all messages to a replica: three classes that overtake each other, late
// snapshots, dropped commits of a chunk that is then sent again, cut connections, crashes that lose
// the tail of the log, rejects, and moving views. At the end every replica has the voxels of the
// authority.
#include <catch2/catch.hpp>
#include <deque>
#include <functional>
#include <set>
#include <string>

#include "client/replica/replica.hpp"
#include "common/core/hash.hpp"
#include "tests/support/codec/authority_model.hpp"
#include "tests/support/codec/chunks_message.hpp"
#include "tests/support/edits/edit_oracle.hpp"

using namespace runstone;
using runstone::test::AuthorityModel;

namespace {

constexpr std::int32_t kEdge = 16;
using Logged = std::pair<OperationId, EditDescriptor>;

struct Rules {
  bool crashes = true;
  bool digest_checks = true;
  bool hide_gaps =
      false;  // sabotage: a dropped commit is not admitted in the next one's previous sequences
};

EditDescriptor random_edit(SplitMix64& rng) {
  const auto coordinate = [&] { return rng.between(-20, 20); };
  const VoxelPos at{coordinate(), coordinate(), coordinate()};
  EditDescriptor edit;
  edit.material = static_cast<Material>(rng.below(5));
  switch (rng.below(6)) {
    case 0:
      edit.shape = SetVoxel{at};
      break;
    case 5:
      edit.shape = Paste{at, test::random_clipboard(rng, 12, 5), test::random_orientation(rng)};
      edit.material = kEmpty;
      break;
    case 2:
      edit.shape = test::random_stroke(rng, at);
      break;
    case 1:
      edit.shape = FillSphere{at, static_cast<std::uint16_t>(rng.below(7))};
      break;
    default:
      edit.shape = FillBox{
          {at, {at.x + rng.between(1, 9), at.y + rng.between(1, 9), at.z + rng.between(1, 9)}}};
  }
  switch (rng.below(4)) {
    case 0:
      edit.mask = {MaskKind::only_empty, kEmpty};
      break;
    case 1:
      edit.mask = {MaskKind::only_material, static_cast<Material>(rng.below(5))};
      break;
    default:
      break;
  }
  return edit;
}

class World;

/// One client, its connection, and the server's state for it.
struct Peer {
  Replica replica;
  AuthorId author = 0;
  // Server to client, by class; in order within each.
  std::deque<std::function<void()>> control, edits, chunks;
  // Client to server, one stream.
  std::deque<std::function<void()>> upstream;
  // Server side.
  View view;
  std::set<ChunkCoord> subscribed;
  std::set<ChunkCoord> stale;        // commits were dropped: a snapshot must follow
  ClientSequence resolved = 0;       // high-water mark
  std::set<ClientSequence> refused;  // until a crash
};

class Simulation {
 public:
  Simulation(std::uint64_t seed, Rules rules) : rng_(seed), rules_(rules) {
    for (std::size_t i = 0; i < peers_.size(); ++i) {
      peers_[i].author = static_cast<AuthorId>(i + 1);
      peers_[i].view = {1, {0, 0, 0}, 2, 2};
      peers_[i].replica.set_view(peers_[i].view);
      connect(peers_[i]);
    }
  }

  void run(int steps) {
    for (int i = 0; i < steps; ++i) step();
    settle();
  }

  /// Returns an empty string if every replica agrees with the authority.
  std::string mismatch() {
    for (Peer& peer : peers_) {
      const Replica& replica = peer.replica;
      for (int x = -2; x <= 2; ++x) {
        for (int y = -2; y <= 2; ++y) {
          for (int z = -2; z <= 2; ++z) {
            const ChunkCoord at{x, y, z};
            if (!replica.view()->contains(at)) continue;
            const ChunkPtr held = replica.confirmed({0, at});
            const std::string where = " in chunk " + std::to_string(x) + "," + std::to_string(y) +
                                      "," + std::to_string(z);
            if (!held) return "nothing held" + where;
            const Chunk& truth = world_.chunk(at);
            if (held->version != truth.version) return "version differs" + where;
            if (digest_of(held->voxels) != truth.digest) return "voxels differ" + where;
            if (held->digest != truth.digest) return "digest did not follow" + where;
            if (replica.shown({0, at}).get() != &held->voxels)
              return "a prediction is left" + where;
          }
        }
      }
      if (!replica.local_edits().all().empty()) return "local edits are left";
      if (replica.awaiting_count() != 0) return "a chunk waits for a snapshot";
    }
    std::set<OperationId> seen;
    for (const auto& [op, edit] : log_) {
      if (!seen.insert(op).second) return "an edit was applied twice";
    }
    for (const OperationId& op : owed_) {
      if (!seen.contains(op)) return "an edit was lost";
    }
    return {};
  }

  ReplicaCounters counters() const {
    ReplicaCounters sum;
    for (const Peer& peer : peers_) {
      const ReplicaCounters& c = peer.replica.counters();
      sum.gaps += c.gaps;
      sum.snapshots_stale += c.snapshots_stale;
      sum.chunk_edits_buffered += c.chunk_edits_buffered;
      sum.chunk_edits_contained += c.chunk_edits_contained;
      sum.dropped_by_epoch += c.dropped_by_epoch;
      sum.drifted += c.drifted;
      sum.answers_outside += c.answers_outside;
    }
    return sum;
  }

  LocalEditCounters local_counters() const {
    LocalEditCounters sum;
    for (const Peer& peer : peers_) {
      const LocalEditCounters& c = peer.replica.local_edits().counters();
      sum.rejected += c.rejected;
      sum.offered_again += c.offered_again;
    }
    return sum;
  }

 private:
  void step() {
    Peer& peer = peers_[rng_.below(static_cast<std::uint32_t>(peers_.size()))];
    const std::uint32_t dice = rng_.below(100);
    if (dice < 20) {
      submit(peer);
    } else if (dice < 40) {
      pop(peer.upstream);
    } else if (dice < 62) {
      pop(peer.edits);
    } else if (dice < 80) {
      pop(peer.chunks);
    } else if (dice < 88) {
      pop(peer.control);
    } else if (dice < 91) {
      for (Peer& p : peers_) send_stale(p);
    } else if (dice < 94) {
      advance_durable();
    } else if (dice < 96) {
      peer.replica.tick(now_ += kRequestAgainUs / 3);
      send_requests(peer);
    } else if (dice < 98) {
      move(peer);
    } else if (dice == 98) {
      connect(peer);
    } else if (rules_.crashes && rng_.below(3) == 0) {
      crash();
    }
    ++now_;
  }

  static void pop(std::deque<std::function<void()>>& queue) {
    if (queue.empty()) return;
    const auto act = std::move(queue.front());
    queue.pop_front();
    act();
  }

  Arrival arrival() const { return {now_, now_, now_}; }

  void submit(Peer& peer) {
    const auto seq = peer.replica.predict(random_edit(rng_), now_, now_);
    if (!seq) return;
    owed_.insert({peer.author, 1, *seq});
    offer(peer, *seq);
  }

  void offer(Peer& peer, ClientSequence seq) {
    const EditDescriptor edit = peer.replica.local_edits().all().at(seq).edit;
    peer.upstream.push_back([this, &peer, seq, edit] { order(peer, seq, edit); });
  }

  void order(Peer& peer, ClientSequence seq, const EditDescriptor& edit) {
    const auto answer = [&](RejectReason reason, Sequence bound) {
      const Reject reject{seq, reason, "", bound};
      peer.control.push_back([this, &peer, reject] { peer.replica.receive(reject, now_); });
    };
    if (peer.refused.contains(seq)) return answer(RejectReason::rate_limited, 0);
    if (seq <= peer.resolved) return answer(RejectReason::already_resolved, world_.head());
    peer.resolved = seq;
    if (rng_.below(8) == 0) {
      owed_.erase({peer.author, 1, seq});
      peer.refused.insert(seq);
      return answer(RejectReason::rate_limited, 0);
    }
    const OperationId op{peer.author, 1, seq};
    log_.emplace_back(op, edit);
    const Commit commit = world_.commit(op, edit, now_);
    for (Peer& p : peers_) {
      bool wanted = p.author == peer.author;
      std::vector<ChunkCoord> dropped;
      for (const ChunkCoord at : touched_chunks(edit, kEdge)) {
        if (!p.subscribed.contains(at)) continue;
        wanted = true;
        // Sometimes the session's queue is full. Then the whole commit is dropped for it, and its
        // chunks are stale.
        dropped.push_back(at);
      }
      if (!wanted) continue;
      const bool full = p.author != peer.author && rng_.below(10) == 0;
      if (full) {
        if (!rules_.hide_gaps) p.stale.insert(dropped.begin(), dropped.end());
        for (const ChunkCoord at : dropped) hidden_[{p.author, at}] = commit.edits.front().seq;
        continue;
      }
      Commit copy = commit;
      if (rules_.hide_gaps) {
        const auto touched = touched_chunks(edit, kEdge);
        for (std::size_t c = 0; c < touched.size(); ++c) {
          const auto it = hidden_.find({p.author, touched[c]});
          if (it == hidden_.end()) continue;
          const ChunkPtr held = p.replica.confirmed({0, touched[c]});
          if (held) copy.edits[0].previous[c] = held->version.seq;
        }
      }
      p.edits.push_back(
          [this, &p, copy] { REQUIRE(p.replica.receive(copy, arrival()).has_value()); });
    }
  }

  void send_snapshot(Peer& peer, ChunkCoord at) {
    const Chunks chunks = test::chunks_of(world_.snapshot(at), peer.view.number);
    peer.chunks.push_back([this, &peer, chunks] { peer.replica.receive(chunks, arrival()); });
  }

  void send_stale(Peer& peer) {
    for (const ChunkCoord at : std::exchange(peer.stale, {})) {
      if (peer.subscribed.contains(at)) send_snapshot(peer, at);
    }
  }

  void send_requests(Peer& peer) {
    for (const ChunkKey& key : peer.replica.take_requests()) {
      peer.upstream.push_back([this, &peer, key] {
        if (peer.subscribed.contains(key.at)) send_snapshot(peer, key.at);
      });
    }
  }

  void move(Peer& peer) {
    const std::uint32_t number = peer.replica.view()->number + 1;
    const View view{number, {rng_.between(-1, 1), rng_.between(-1, 1), rng_.between(-1, 1)}, 2, 2};
    peer.replica.set_view(view);
    peer.upstream.push_back([this, &peer, view] { subscribe(peer, view); });
  }

  void subscribe(Peer& peer, const View& view) {
    peer.view = view;
    std::erase_if(peer.subscribed, [&](ChunkCoord at) { return !view.contains(at); });
    for (int x = -3; x <= 3; ++x) {
      for (int y = -3; y <= 3; ++y) {
        for (int z = -3; z <= 3; ++z) {
          const ChunkCoord at{x, y, z};
          if (view.contains(at) && peer.subscribed.insert(at).second) send_snapshot(peer, at);
        }
      }
    }
  }

  void connect(Peer& peer) {
    peer.control.clear();
    peer.edits.clear();
    peer.chunks.clear();
    peer.upstream.clear();
    peer.subscribed.clear();
    peer.stale.clear();
    const auto offers = peer.replica.open(
        {kEdge, peer.author, 1, world_.epoch(), durable_, world_.head(), peer.resolved});
    const View view = *peer.replica.view();
    peer.upstream.push_back([this, &peer, view] { subscribe(peer, view); });
    for (const ClientSequence seq : offers) offer(peer, seq);
  }

  void advance_durable() {
    durable_ = world_.head();
    for (Peer& peer : peers_) {
      peer.control.push_back([&peer, seq = durable_, epoch = world_.epoch()] {
        peer.replica.receive(Durable{epoch, seq});
      });
      if (!rules_.digest_checks) continue;
      DigestCheck check;
      for (const ChunkCoord at : peer.subscribed) {
        check.entries.push_back({{0, at}, world_.chunk(at).version, world_.chunk(at).digest});
      }
      peer.control.push_back([this, &peer, check] { peer.replica.receive(check, now_); });
    }
  }

  void crash() {
    log_.resize(durable_);
    for (Peer& peer : peers_) {
      peer.resolved = 0;
      peer.refused.clear();
      for (const auto& [op, edit] : log_) {
        if (op.author == peer.author) peer.resolved = std::max(peer.resolved, op.seq);
      }
    }
    world_.restart(log_);
    for (Peer& peer : peers_) connect(peer);
  }

  /// Delivers all messages, sends all snapshots that must follow, and makes all edits durable.
  void settle() {
    for (int round = 0; round < 12; ++round) {
      now_ += kRequestAgainUs;
      for (Peer& peer : peers_) {
        for (auto* queue : {&peer.upstream, &peer.edits, &peer.control, &peer.chunks}) {
          while (!queue->empty()) pop(*queue);
        }
        peer.replica.tick(now_);
        send_requests(peer);
        send_stale(peer);
      }
      if (round >= 6) advance_durable();
    }
    for (Peer& peer : peers_) {
      while (!peer.control.empty()) pop(peer.control);
    }
  }

  SplitMix64 rng_;
  Rules rules_;
  AuthorityModel world_{kEdge, 1};
  std::array<Peer, 3> peers_;
  std::vector<Logged> log_;
  std::set<OperationId> owed_;  // submitted and not rejected
  std::map<std::pair<AuthorId, ChunkCoord>, Sequence> hidden_;
  Sequence durable_ = 0;
  TimeUs now_ = 0;
};

}  // namespace

TEST_CASE("replicas agree with the authority after any interleaving, cut and crash",
          "[replica][property]") {
  ReplicaCounters sum;
  LocalEditCounters local_sum;
  for (std::uint64_t round = 0; round < 60; ++round) {
    const std::uint64_t seed = mix64(Catch::rngSeed() + round);
    CAPTURE(Catch::rngSeed(), round, seed);
    Simulation simulation(seed, {});
    simulation.run(600);
    REQUIRE(simulation.mismatch() == "");
    const ReplicaCounters c = simulation.counters();
    CHECK(c.drifted == 0);
    sum.gaps += c.gaps;
    sum.snapshots_stale += c.snapshots_stale;
    sum.chunk_edits_buffered += c.chunk_edits_buffered;
    sum.chunk_edits_contained += c.chunk_edits_contained;
    local_sum.rejected += simulation.local_counters().rejected;
    local_sum.offered_again += simulation.local_counters().offered_again;
    sum.dropped_by_epoch += c.dropped_by_epoch;
    sum.answers_outside += c.answers_outside;
  }
  // The interleavings cover these cases.
  CHECK(sum.gaps > 0);
  CHECK(sum.snapshots_stale > 0);
  CHECK(sum.chunk_edits_buffered > 0);
  CHECK(sum.chunk_edits_contained > 0);
  CHECK(local_sum.offered_again > 0);
  CHECK(local_sum.rejected > 0);
  CHECK(sum.dropped_by_epoch > 0);
  CHECK(sum.answers_outside > 0);
}

TEST_CASE("a server that hides a dropped commit is caught by the comparison",
          "[replica][property]") {
  int caught = 0;
  for (std::uint64_t round = 0; round < 8; ++round) {
    Simulation simulation(mix64(Catch::rngSeed() + round),
                          {.crashes = false, .digest_checks = false, .hide_gaps = true});
    simulation.run(400);
    if (!simulation.mismatch().empty()) ++caught;
  }
  CHECK(caught > 0);
}
