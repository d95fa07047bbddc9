// Replicas of veiled sessions. A server's authority and shown chunks send them snapshots, commits and
// patches as encoded messages, in three classes that overtake each other. Messages get lost with the
// snapshots that then follow, chunks leave the server's memory, and replicas edit with predictions. At
// the end every replica has the voxels and the digests of the shown chunks.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "client/replica/replica.hpp"
#include "common/runs/reorder.hpp"
#include "protocol/codec/commit_encoder.hpp"
#include "protocol/codec/message_table.hpp"
#include "server/world/veil/shown_chunks.hpp"
#include "server/world/veil/veiled_messages.hpp"
#include "tests/support/codec/chunks_message.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kEdge = 16;
constexpr Material kOre = 6;
using Actions = std::deque<std::function<void()>>;

EditLimits veiled_limits() {
  EditLimits out;
  out.chunk_edge = kEdge;
  out.material_count = 8;
  out.volume_max = 50'000;
  return out;
}

SessionParameters veiled_session(AuthorId author) {
  SessionParameters out;
  out.chunk_edge = kEdge;
  out.author = author;
  out.instance = 1;
  out.epoch = 1;
  out.is_veiled = true;
  return out;
}

struct VeiledRules {
  bool has_faults = true;      // messages get lost, chunks leave memory, and clients repair that
  bool loses_patches = false;  // sabotage: patches of arrived neighbours are not sent
};

struct VeiledPeer {
  Replica replica;
  AuthorId author = 0;
  Actions edits, chunks, upstream;
  std::set<ChunkKey> subscribed;
};

class VeiledServer {
 public:
  VeiledServer(std::uint64_t seed, VeiledRules rules) : rng_{seed}, rules_(rules) {
    for (std::int32_t x = -1; x <= 0; ++x)
      for (std::int32_t y = -1; y <= 0; ++y)
        for (std::int32_t z = -1; z <= 0; ++z) {
          RunChunk ground = uniform_chunk(Extent::cube(kEdge), kStone, random_order(rng_));
          for (int i = 0; i < 200; ++i)
            fill(ground, rng_.below(ground.volume()), 1, static_cast<Material>(6 + rng_.below(2)));
          for (int i = 0; i < 4; ++i) fill(ground, rng_.below(ground.volume() - 40), 30, kEmpty);
          stored_.emplace(ChunkKey{0, {x, y, z}}, Chunk{std::move(ground), {}, {}});
        }
    for (auto& [key, chunk] : stored_) {
      chunk.digest = digest_of(chunk.voxels);
      if (rng_.below(3) != 0) load(key);
    }
    for (std::size_t i = 0; i < peers_.size(); ++i) {
      VeiledPeer& peer = peers_[i];
      peer.author = static_cast<AuthorId>(i + 1);
      peer.replica.set_view({1, {0, 0, 0}, 2, 2});
      peer.replica.open(veiled_session(peer.author));
      subscribe(peer);
    }
  }

  void step() {
    VeiledPeer& peer = peers_[rng_.below(static_cast<std::uint32_t>(peers_.size()))];
    const std::uint32_t dice = rng_.below(100);
    if (dice < 30) {
      predict(peer);
    } else if (dice < 50) {
      pop(peer.upstream);
    } else if (dice < 70) {
      pop(peer.edits);
    } else if (dice < 85) {
      pop(peer.chunks);
    } else if (dice < 90) {
      load(any_chunk());
      for (VeiledPeer& each : peers_) subscribe(each);
    } else if (dice < 93) {
      if (rules_.has_faults) unload(any_chunk());
    } else if (dice < 95) {
      rollback();
    } else {
      repair(peer);
    }
    ++now_;
  }

  void settle() {
    for (int round = 0; round < 6; ++round) {
      now_ += kRequestAgainUs;
      for (const auto& [key, chunk] : stored_) load(key);
      for (VeiledPeer& peer : peers_) {
        subscribe(peer);
        for (Actions* queue : {&peer.upstream, &peer.edits, &peer.chunks}) {
          while (!queue->empty()) pop(*queue);
        }
        peer.replica.tick(now_);
        repair(peer);
      }
      commit();
    }
    const Durable durable{1, authority_.head(), false};
    for (VeiledPeer& peer : peers_) peer.replica.receive(durable);
  }

  std::string mismatch() {
    for (VeiledPeer& peer : peers_) {
      for (const auto& [key, stored] : stored_) {
        const ChunkPtr held = peer.replica.confirmed(key), shown = shown_.find(key);
        if (held == nullptr || shown == nullptr) return "a chunk is missing";
        if (held->version != shown->version) return "a version differs";
        if (digest_of(held->voxels) != shown->digest) return "voxels differ";
        if (held->digest != shown->digest) return "the digest did not follow";
        if (peer.replica.shown(key).get() != &held->voxels) return "a prediction is left";
      }
      if (!peer.replica.local_edits().all().empty()) return "local edits are left";
    }
    return {};
  }

  ReplicaCounters counters() const {
    ReplicaCounters sum;
    for (const VeiledPeer& peer : peers_) {
      sum.patches_applied += peer.replica.counters().patches_applied;
      sum.chunk_edits_buffered += peer.replica.counters().chunk_edits_buffered;
      sum.gaps += peer.replica.counters().gaps;
    }
    return sum;
  }
  int receipts() const { return receipts_; }
  int arrivals() const { return arrivals_; }

 private:
  static void pop(Actions& queue) {
    if (queue.empty()) return;
    const auto act = std::move(queue.front());
    queue.pop_front();
    act();
  }
  Arrival arrival() const { return {now_, now_, now_}; }
  WorldChunks& chunks() { return authority_.chunks(); }
  Version newest() const { return {authority_.epoch(), authority_.head()}; }

  ChunkKey any_chunk() {
    const auto one = [&] { return -static_cast<std::int32_t>(rng_.below(2)); };
    const std::int32_t x = one(), y = one(), z = one();
    return {0, {x, y, z}};
  }

  /// Sends a message through the codec.
  template <class Kind>
  void send_edit_class(VeiledPeer& peer, const Kind& message) {
    const EncodedMessage encoded = encode_message(message);
    peer.edits.push_back([this, &peer, encoded] {
      auto decoded = decode_message(Sender::server, encoded.kind, *encoded.bytes, kEdge);
      REQUIRE(decoded.has_value());
      REQUIRE(peer.replica.receive(std::get<Kind>(*decoded), arrival()).has_value());
    });
  }

  void subscribe(VeiledPeer& peer) {
    for (const auto& [key, stored] : stored_) {
      if (peer.subscribed.contains(key) || shown_.make(key, newest()) == nullptr) continue;
      peer.subscribed.insert(key);
      send_snapshot(peer, key);
    }
  }

  void send_snapshot(VeiledPeer& peer, const ChunkKey& key) {
    const Chunk& shown = *shown_.find(key);
    const Chunks message = chunks_of(ChunkSnapshot{
        key, {reorder(shown.voxels, random_order(own_)), shown.version, shown.digest}});
    peer.chunks.push_back([this, &peer, message] { peer.replica.receive(message, arrival()); });
  }

  /// A message did not fit the queue: snapshots follow.
  void mark_outdated(VeiledPeer& peer, const ChunkKey& key) {
    if (peer.subscribed.erase(key) == 0) return;
    peer.upstream.push_back([this, &peer] { subscribe(peer); });
  }

  void load(const ChunkKey& key) {
    if (!chunks().begin_load(key)) return;
    REQUIRE(chunks().loaded(key, stored_.at(key)).has_value());
    const std::vector<ShownPatch> patches = shown_.uncover_beside(key, newest());
    arrivals_ += static_cast<int>(patches.size());
    for (VeiledPeer& peer : peers_) {
      std::vector<ShownPatch> some;
      for (const ShownPatch& patch : patches) {
        if (peer.subscribed.contains(patch.key)) some.push_back(patch);
      }
      if (some.empty() || rules_.loses_patches) continue;
      if (rules_.has_faults && rng_.below(4) == 0) {
        for (const ShownPatch& patch : some) mark_outdated(peer, patch.key);
      } else {
        send_edit_class(peer, veil_patches(some));
      }
    }
  }

  void unload(const ChunkKey& key) {
    const ChunkPtr chunk = chunks().find(key);
    if (chunk == nullptr) return;
    stored_.at(key) = *chunk;
    shown_.drop(key);
    for (VeiledPeer& peer : peers_) peer.subscribed.erase(key);
    chunks().mark_saved(key, chunk->version);
    chunks().released(key);
    chunks().evict(0, 100, [&](const ChunkKey& other) { return other != key; });
  }

  EditDescriptor random_edit() {
    EditDescriptor edit;
    const VoxelPos at{rng_.between(-16, 15), rng_.between(-16, 15), rng_.between(-16, 15)};
    edit.material = rng_.below(2) == 0 ? kEmpty : static_cast<Material>(rng_.below(8));
    if (rng_.below(8) == 0) {
      do {
        edit = random_edit_near(rng_, origin_of(any_chunk().at, kEdge), Extent::cube(kEdge));
      } while (authority_.check(edit));
    } else if (rng_.below(3) == 0) {
      edit.shape = FillBox{{at, {at.x + 3, at.y + 2, at.z + 4}}};
      if (rng_.below(4) == 0) edit.mask = {MaskKind::only_material, kOre};
    } else {
      edit.shape = SetVoxel{at};
    }
    return edit;
  }

  void predict(VeiledPeer& peer) {
    const EditDescriptor edit = random_edit();
    const auto seq = peer.replica.predict(edit, now_, now_);
    if (!seq) return;
    peer.upstream.push_back([this, &peer, edit, seq = *seq] {
      REQUIRE(authority_.enqueue({{peer.author, 1, seq}, Cause::player, 0, edit}).has_value());
      if (rng_.below(3) != 0) commit();
    });
  }

  void rollback() {
    REQUIRE(
        authority_.enqueue({{0, 9, ++own_seq_}, Cause::rollback, 0, random_edit()}).has_value());
    commit();
  }

  void commit() {
    const auto batch = authority_.commit({now_, now_});
    if (!batch) return;
    const std::vector<ShownEdit> shown = shown_.apply(*batch);
    const VeiledCommit all = veiled_commit(*batch, shown);
    const CommitEncoder encoder(all);
    for (VeiledPeer& peer : peers_) {
      std::vector<std::uint32_t> some;
      std::vector<ChunkKey> concerned;
      bool has_own = false;
      for (std::uint32_t i = 0; i < shown.size(); ++i) {
        const bool is_own = batch->commit.edits[i].op.author == peer.author;
        std::vector<ChunkKey> keys;
        if (shown[i].form == ShownForm::descriptor) keys = batch->touched[i];
        for (const ShownPatch& patch : shown[i].patches) keys.push_back(patch.key);
        const bool is_seen = std::ranges::any_of(
            keys, [&](const ChunkKey& key) { return peer.subscribed.contains(key); });
        if (!is_seen && !is_own) continue;
        receipts_ += is_own && shown[i].form == ShownForm::hidden ? 1 : 0;
        has_own = has_own || is_own;
        some.push_back(i);
        concerned.insert(concerned.end(), keys.begin(), keys.end());
      }
      if (some.empty()) continue;
      if (rules_.has_faults && !has_own && rng_.below(8) == 0) {
        for (const ChunkKey& key : concerned) mark_outdated(peer, key);
        continue;
      }
      const EncodedMessage encoded = encode_message(encoder, some);
      peer.edits.push_back([this, &peer, encoded] {
        auto decoded = decode_message(Sender::server, encoded.kind, *encoded.bytes, kEdge);
        REQUIRE(decoded.has_value());
        const auto taken = peer.replica.receive(std::get<VeiledCommit>(*decoded), arrival());
        REQUIRE(taken.has_value());
      });
    }
  }

  void repair(VeiledPeer& peer) {
    if (!rules_.has_faults) return;
    check_digests(peer);
    request(peer);
  }

  void check_digests(VeiledPeer& peer) {
    DigestCheck check;
    for (const ChunkKey& key : peer.subscribed) {
      const ChunkPtr shown = shown_.find(key);
      check.entries.push_back({key, shown->version, shown->digest});
    }
    if (check.entries.empty()) return;
    // In this test a check never overtakes the messages before it.
    peer.edits.push_back([this, &peer, check] { peer.replica.receive(check, now_); });
  }

  void request(VeiledPeer& peer) {
    for (const ChunkKey& key : peer.replica.take_requests()) {
      peer.upstream.push_back([this, &peer, key] {
        if (peer.subscribed.contains(key)) send_snapshot(peer, key);
      });
    }
  }

  SplitMix64 rng_;
  SplitMix64 own_{1};
  const VeiledRules rules_;
  Authority authority_{veiled_limits(), {1, 0, 0}};
  ShownChunks shown_{authority_.chunks(), kEdge, mesh_materials()};
  std::map<ChunkKey, Chunk> stored_;
  std::array<VeiledPeer, 3> peers_;
  ClientSequence own_seq_ = 0;
  TimeUs now_ = 0;
  int receipts_ = 0, arrivals_ = 0;
};

}  // namespace

TEST_CASE("replicas of veiled sessions agree with the shown chunks after any interleaving",
          "[replica][veil][property]") {
  ReplicaCounters sum;
  int receipts = 0, arrivals = 0;
  for (std::uint64_t round = 0; round < 25; ++round) {
    const std::uint64_t seed = mix64(Catch::rngSeed() + round);
    CAPTURE(Catch::rngSeed(), round);
    VeiledServer server(seed, {});
    for (int i = 0; i < 400; ++i) server.step();
    server.settle();
    REQUIRE(server.mismatch() == "");
    const ReplicaCounters c = server.counters();
    sum.patches_applied += c.patches_applied;
    sum.chunk_edits_buffered += c.chunk_edits_buffered;
    sum.gaps += c.gaps;
    receipts += server.receipts();
    arrivals += server.arrivals();
  }
  CHECK(sum.patches_applied > 100);
  CHECK(sum.chunk_edits_buffered > 0);
  CHECK(sum.gaps > 0);
  CHECK(receipts > 0);
  CHECK(arrivals > 0);
}

TEST_CASE("a server that does not send the patches of arrived neighbours is caught",
          "[replica][veil][property]") {
  int caught = 0;
  for (std::uint64_t round = 0; round < 6; ++round) {
    const std::uint64_t seed = mix64(Catch::rngSeed() + round);
    CAPTURE(Catch::rngSeed(), round);
    const auto mismatch = [&](bool loses_patches) {
      VeiledServer server(seed, {.has_faults = false, .loses_patches = loses_patches});
      for (int i = 0; i < 200; ++i) server.step();
      server.settle();
      return server.mismatch();
    };
    CHECK(mismatch(false) == "");
    caught += mismatch(true).empty() ? 0 : 1;
  }
  CHECK(caught > 0);
}

TEST_CASE("a prediction in rock shows no hole, and the commit shows the ore", "[replica][veil]") {
  Authority authority(veiled_limits(), {1, 0, 0});
  ShownChunks shown(authority.chunks(), kEdge, mesh_materials());
  const ChunkKey key{0, {0, 0, 0}};
  RunChunk ground = uniform_chunk(Extent::cube(kEdge), kStone);
  fill(ground, index_of({8, 8, 8}, ground.extent, ground.order), 1, kEmpty);
  fill(ground, index_of({8, 8, 10}, ground.extent, ground.order), 1, kOre);
  const Digest digest = digest_of(ground);
  REQUIRE(authority.chunks().begin_load(key));
  REQUIRE(authority.chunks().loaded(key, {std::move(ground), {}, digest}).has_value());

  Replica replica;
  replica.set_view({1, {0, 0, 0}, 1, 1});
  replica.open(veiled_session(1));
  replica.receive(chunks_of(ChunkSnapshot{key, *shown.make(key, {1, 0})}), {});
  CHECK(replica.shown_at({8, 8, 10}) == kStone);

  const auto order = [&](const EditDescriptor& edit) {
    const auto seq = replica.predict(edit, 0, 0);
    REQUIRE(seq.has_value());
    REQUIRE(authority.enqueue({{1, 1, *seq}, Cause::player, 0, edit}).has_value());
    const auto batch = authority.commit({0, 0});
    return veiled_commit(*batch, shown.apply(*batch));
  };
  // The ore beside the dug voxel is still shown as stone.
  const VeiledCommit dug = order({SetVoxel{{8, 8, 9}}, {}, kEmpty});
  CHECK(replica.shown_at({8, 8, 9}) == kEmpty);
  CHECK(replica.shown_at({8, 8, 10}) == kStone);
  REQUIRE(dug.edits.size() == 1);
  CHECK(dug.edits[0].has_edit);
  REQUIRE(replica.receive(dug, {}).has_value());
  CHECK(replica.shown_at({8, 8, 10}) == kOre);
  CHECK(replica.shown({0, {0, 0, 0}}).get() == &replica.confirmed(key)->voxels);

  // An edit in closed rock is answered with a receipt, which removes the prediction.
  const VeiledCommit hidden = order({SetVoxel{{3, 3, 3}}, {}, kDirt});
  CHECK(replica.shown_at({3, 3, 3}) == kDirt);
  CHECK_FALSE(hidden.edits[0].has_edit);
  CHECK(hidden.edits[0].patches.empty());
  const Version version = replica.confirmed(key)->version;
  REQUIRE(replica.receive(hidden, {}).has_value());
  CHECK(replica.shown_at({3, 3, 3}) == kStone);
  CHECK(replica.confirmed(key)->version == version);
}

TEST_CASE("a replica refuses veiled commits whose patches do not fit their edit",
          "[replica][veil]") {
  Replica replica;
  replica.set_view({1, {0, 0, 0}, 1, 1});
  replica.open(veiled_session(1));
  VeiledCommit commit{1, {{}}};
  VeiledEdit& edit = commit.edits[0];
  edit.ordered.seq = 5;
  edit.ordered.op = {2, 2, 1};
  edit.ordered.edit = {SetVoxel{{0, 0, 0}}, {}, kStone};
  edit.ordered.previous = {0};
  edit.has_edit = true;
  const VeilPatch patch{Extent::cube(kEdge), kVeilOrder, {{0, 1, kStone}}};
  edit.patches = {{{0, 0, 0}, 4, patch}};
  CHECK_FALSE(replica.receive(commit, {}).has_value());
  edit.patches = {{{0, 0, 1}, 5, patch}};
  CHECK_FALSE(replica.receive(commit, {}).has_value());
  edit.patches = {{{0, 0, 0}, 5, patch}, {{0, 0, 1}, 0, patch}};
  CHECK(replica.receive(commit, {}).has_value());
  commit.epoch = 2;
  CHECK_FALSE(replica.receive(commit, {}).has_value());
  CHECK_FALSE(replica.receive(VeilPatches{{2, 5}, edit.patches}, {}).has_value());
  CHECK(replica.receive(VeilPatches{{1, 5}, edit.patches}, {}).has_value());
}

TEST_CASE("chunks with a veil are not kept for a session without one", "[replica][veil]") {
  Replica replica;
  replica.set_view({1, {0, 0, 0}, 1, 1});
  replica.open(veiled_session(1));
  const ChunkKey key{0, {0, 0, 0}};
  const RunChunk stone = uniform_chunk(Extent::cube(kEdge), kStone);
  replica.receive(chunks_of(ChunkSnapshot{key, {stone, {}, digest_of(stone)}}), {});
  SessionParameters again = veiled_session(1);
  replica.open(again);
  CHECK(replica.confirmed(key) != nullptr);
  again.is_veiled = false;
  replica.open(again);
  CHECK(replica.confirmed(key) == nullptr);
}

TEST_CASE("a patch that the chunk of the server lacks is not applied again", "[replica][veil]") {
  Replica replica;
  replica.set_view({1, {0, 0, 0}, 1, 1});
  replica.open(veiled_session(1));
  const ChunkKey key{0, {0, 0, 0}};
  const RunChunk stone = uniform_chunk(Extent::cube(kEdge), kStone);
  const Digest digest = digest_of(stone);
  const auto send_snapshot = [&] {
    replica.receive(chunks_of(ChunkSnapshot{key, {stone, {}, digest}}), {});
  };
  send_snapshot();
  const VeilPatch patch{Extent::cube(kEdge), kVeilOrder, {{0, 1, kOre}}};
  REQUIRE(replica.receive(VeilPatches{{}, {{key.at, 0, patch}}}, {}).has_value());
  CHECK(replica.shown_at({0, 0, 0}) == kOre);
  replica.receive(DigestCheck{{{key, {}, digest}}}, 1);
  CHECK(replica.take_requests() == std::vector<ChunkKey>{key});
  send_snapshot();
  CHECK(replica.shown_at({0, 0, 0}) == kStone);
  replica.receive(DigestCheck{{{key, {}, digest}}}, 2);
  CHECK(replica.take_requests().empty());
  CHECK(replica.counters().drifted == 1);
}

TEST_CASE("the cache gets a chunk again when its voxels change at one version", "[replica][veil]") {
  Replica replica;
  replica.collect_for_cache();
  replica.set_view({1, {0, 0, 0}, 1, 1});
  SessionParameters session = veiled_session(1);
  replica.open(session);
  const ChunkKey key{0, {0, 0, 0}};
  const auto send_snapshot = [&](Material material) {
    const RunChunk voxels = uniform_chunk(Extent::cube(kEdge), material);
    replica.receive(chunks_of(ChunkSnapshot{key, {voxels, {}, digest_of(voxels)}}), {});
  };
  send_snapshot(kStone);
  CHECK(replica.take_for_cache(9).size() == 1);
  CHECK(replica.take_for_cache(9).empty());
  const VeilPatch patch{Extent::cube(kEdge), kVeilOrder, {{0, 1, kOre}}};
  REQUIRE(replica.receive(VeilPatches{{}, {{key.at, 0, patch}}}, {}).has_value());
  CHECK(replica.take_for_cache(9).size() == 1);
  CHECK(replica.take_for_cache(9).empty());
  session.is_veiled = false;
  replica.open(session);
  send_snapshot(kOre);
  CHECK(replica.take_for_cache(9).size() == 1);
}

TEST_CASE("the patches that a chunk keeps are bounded by their spans", "[replica][veil]") {
  // Each voxel is a span.
  const Extent extent = Extent::cube(kEdge);
  VeilPatch patch{extent, kVeilOrder, {}};
  for (VoxelIndex i = 0; i < extent.volume(); ++i)
    patch.spans.push_back({i, 1, i % 2 == 0 ? kStone : kOre});
  const Sequence fitting = kPatchSpansMax / extent.volume();
  REQUIRE(fitting < kRepeatedPatchesMax);
  const ChunkKey key{0, {0, 0, 0}};

  // In the inbox.
  Replica replica;
  replica.set_view({1, {0, 0, 0}, 1, 1});
  replica.open(veiled_session(1));
  for (Sequence seq = 1; seq <= fitting + 1; ++seq) {
    CHECK(replica.counters().buffer_overflows == 0);
    REQUIRE(replica.receive(VeilPatches{{1, seq}, {{key.at, seq - 1, patch}}}, {}).has_value());
  }
  CHECK(replica.counters().buffer_overflows == 1);

  // At the version of the chunk.
  ReplicaChunks chunks;
  TrackedChunk& chunk = *chunks.track(key).first;
  chunks.set_current(chunk,
                     std::make_shared<const Chunk>(Chunk{uniform_chunk(extent, kStone), {}, {}}));
  const auto shared = std::make_shared<const VeilPatch>(patch);
  for (Sequence i = 0; i <= fitting; ++i) chunk.inbox.push_back({nullptr, 0, {}, false, shared});
  CHECK(chunk.take_ready_edits().patches.size() == fitting + 1);
  CHECK(chunk.repeatable.size() == fitting);
}

}  // namespace runstone::test
