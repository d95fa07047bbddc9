// True and shown chunks under random edits, while chunks leave memory and arrive again. Replicas get
// what veiled sessions get, and nothing else. At every check they have the digests of the shown
// chunks, and every byte that was sent is the same whatever the voxels are that were never uncovered.
#include "server/world/veil/shown_chunks.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/edits/apply/edit_stack.hpp"
#include "common/materials/veil_visibility.hpp"
#include "common/runs/reorder.hpp"
#include "common/veil/veil_patch_bytes.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/support/veil/veil_oracle.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kEdge = 16;
constexpr std::int32_t kSide = 2;  // chunks along each axis
constexpr Material kOre = 6, kOtherOre = 7;

/// Mistakes of the server that the comparison must find.
enum class VeilSabotage {
  none,
  sends_truth,          // snapshots have the true voxels
  forgets_neighbours,   // patches of chunks that the edit does not touch are not sent
  sends_mask_as_it_is,  // replicas apply edits with a mask for one material themselves
  forgets_arrivals,     // a chunk that arrives uncovers nothing
};

bool covers_in_veil(Material material) {
  static const VisibilityTable table(veil_visibilities(mesh_materials()));
  return table[material] == Visibility::opaque;
}

using Dense = std::map<ChunkCoord, DenseChunk>;
using Told = std::map<ChunkCoord, std::vector<bool>>;  // by the order kVeilOrder

struct ShownReplica {
  struct Held {
    RunChunk voxels;
    Version version;
  };
  std::map<ChunkKey, Held> chunks;
};

/// Voxels of the first ground, in which some that were never uncovered may be replaced.
using Ground = std::map<ChunkCoord, RunChunk>;

Ground ore_ground(SplitMix64& rng) {
  Ground out;
  for (std::int32_t x = 0; x < kSide; ++x)
    for (std::int32_t y = 0; y < kSide; ++y)
      for (std::int32_t z = 0; z < kSide; ++z) {
        RunChunk ground = uniform_chunk(Extent::cube(kEdge), kStone, random_order(rng));
        for (int i = 0; i < 300; ++i)
          fill(ground, rng.below(ground.volume()), 1, rng.below(2) == 0 ? kOre : kOtherOre);
        for (int i = 0; i < 4; ++i) fill(ground, rng.below(ground.volume() - 40), 30, kEmpty);
        out.emplace(ChunkCoord{x, y, z}, std::move(ground));
      }
  return out;
}

class ShownWorld {
 public:
  ShownWorld(std::uint64_t seed, Ground ground, VeilSabotage sabotage, bool has_masks)
      : rng_{seed}, sabotage_(sabotage), has_masks_(has_masks), stored_(std::move(ground)) {
    for (const auto& [at, voxels] : stored_)
      told_.emplace(at, std::vector<bool>(voxels.volume(), false));
    for (const auto& [at, voxels] : stored_) {
      if (rng_.below(4) != 0) load({0, at});
    }
    watch_all();
  }

  void step() {
    const std::uint32_t dice = rng_.below(12);
    if (dice == 0) {
      unload(any_chunk());
    } else if (dice <= 2) {
      load(any_chunk());
      watch_all();
    } else if (dice == 3) {
      // Everybody has left: the shown chunk is made again.
      const ChunkKey key = any_chunk();
      shown_.drop(key);
      for (ShownReplica& replica : replicas_) replica.chunks.erase(key);
      watch_all();
    } else {
      commit();
    }
  }

  /// Returns an empty string if replicas and shown chunks agree, and the rule holds.
  std::string mismatch() {
    if (is_gap_) return "a message does not follow the one before";
    for (const auto& [at, voxels] : stored_) {
      const ChunkKey key{0, at};
      const ChunkPtr shown = shown_.find(key), truth = chunks().find(key);
      if ((shown == nullptr) != (truth == nullptr)) return "a chunk is not shown";
      if (shown == nullptr) continue;
      if (!validate(shown->voxels) || shown->voxels.order != kVeilOrder) return "bad runs";
      if (digest_of(shown->voxels) != shown->digest) return "the digest did not follow";
      for (const ShownReplica& replica : replicas_) {
        const ShownReplica::Held& held = replica.chunks.at(key);
        if (held.version != shown->version) return "a version differs";
        if (digest_of(held.voxels) != shown->digest) return "a replica differs";
      }
      const DenseScene scene = DenseScene::of(truth->voxels, beyond(at));
      const DenseChunk dense = DenseChunk::of(shown->voxels);
      const DenseChunk& made = made_.at(at);
      for (VoxelIndex i = 0; i < shown->voxels.volume(); ++i) {
        const VoxelPos p = dense_pos(dense.extent(), kVeilOrder, i);
        const Material is = scene.chunk.at(p.x, p.y, p.z), seen = dense.at(p.x, p.y, p.z);
        if (is != seen && !(covers_in_veil(seen) && oracle_encloses(scene, p, rules_)))
          return "a voxel that is not enclosed differs";
        if (!told_.at(at)[i] && seen != made.at(p.x, p.y, p.z))
          return "a voxel changed that nothing uncovered";
      }
    }
    return {};
  }

  /// Replaces voxels of the ground that no byte may depend on.
  Ground with_other_ore(const Ground& ground, SplitMix64& rng) const {
    Ground out = ground;
    for (auto& [at, chunk] : out) {
      for (VoxelIndex i = 0; i < chunk.volume(); ++i) {
        const VoxelPos p = dense_pos(chunk.extent, kVeilOrder, i);
        const LocalPos local{static_cast<std::uint8_t>(p.x), static_cast<std::uint8_t>(p.y),
                             static_cast<std::uint8_t>(p.z)};
        if (ever_open_.contains({at, i}) || !covers_in_veil(material_at(chunk, local))) continue;
        constexpr std::array<Material, 4> kChoice{kStone, kDirt, kOre, kOtherOre};
        fill(chunk, index_of(local, chunk.extent, chunk.order), 1, kChoice[rng.below(4)]);
      }
    }
    return out;
  }

  const Bytes& sent() const { return sent_; }
  int count_of(ShownForm form) const { return forms_[static_cast<std::size_t>(form)]; }
  int arrivals() const { return arrivals_; }
  std::size_t never_open() const {
    return stored_.size() * kEdge * kEdge * kEdge - ever_open_.size();
  }

 private:
  WorldChunks& chunks() { return authority_.chunks(); }

  ChunkKey any_chunk() {
    const auto one = [&] { return static_cast<std::int32_t>(rng_.below(kSide)); };
    const std::int32_t x = one(), y = one(), z = one();
    return {0, {x, y, z}};
  }

  std::array<const RunChunk*, kDirectionCount> beyond(ChunkCoord at) {
    std::array<const RunChunk*, kDirectionCount> out{};
    for (std::size_t d = 0; d < out.size(); ++d) {
      const ChunkPtr found = chunks().find({0, neighbour(at, static_cast<Direction>(d))});
      if (found != nullptr) out[d] = &found->voxels;
    }
    return out;
  }

  Version newest() const { return {authority_.epoch(), authority_.head()}; }

  void load(const ChunkKey& key) {
    if (chunks().residency(key) != Residency::absent) return;
    Chunk chunk{stored_.at(key.at), saved_[key], {}};
    chunk.digest = digest_of(chunk.voxels);
    REQUIRE(chunks().begin_load(key));
    REQUIRE(chunks().loaded(key, std::move(chunk)).has_value());
    note_open();
    const std::vector<ShownPatch> patches = shown_.uncover_beside(key, newest());
    arrivals_ += static_cast<int>(patches.size());
    if (sabotage_ == VeilSabotage::forgets_arrivals) return;
    for (const ShownPatch& patch : patches) send(patch);
  }

  void unload(const ChunkKey& key) {
    const ChunkPtr chunk = chunks().find(key);
    if (chunk == nullptr) return;
    stored_.at(key.at) = chunk->voxels;
    saved_[key] = chunk->version;
    shown_.drop(key);
    for (ShownReplica& replica : replicas_) replica.chunks.erase(key);
    chunks().mark_saved(key, chunk->version);
    chunks().released(key);
    chunks().evict(0, 100, [&](const ChunkKey& other) { return other != key; });
    REQUIRE(chunks().find(key) == nullptr);
  }

  /// Sends the chunks in memory that a replica lacks.
  void watch_all() {
    for (const auto& [at, voxels] : stored_) {
      const ChunkKey key{0, at};
      const bool is_new = !shown_.has(key);
      const ChunkPtr shown = shown_.make(key, newest());
      if (shown == nullptr) continue;
      const ChunkPtr truth = chunks().find(key);
      if (is_new) {
        const DenseScene scene = DenseScene::of(truth->voxels, beyond(at));
        const DenseChunk made = oracle_veil(scene, kVeilOrder, rules_);
        if (sabotage_ == VeilSabotage::none) REQUIRE(DenseChunk::of(shown->voxels) == made);
        made_.insert_or_assign(at, made);
        told_.at(at).assign(told_.at(at).size(), false);
      }
      const RunChunk& sent = sabotage_ == VeilSabotage::sends_truth ? truth->voxels : shown->voxels;
      for (ShownReplica& replica : replicas_) {
        if (replica.chunks.contains(key)) continue;
        replica.chunks.emplace(
            key, ShownReplica::Held{reorder(sent, random_order(own_)), shown->version});
      }
      write(key, shown->version);
      sent.runs.visit([&](auto runs) {
        for (std::size_t r = 0; r < runs.size(); ++r) {
          ByteWriter out(sent_);
          out.varint(runs.end(r));
          out.varint(runs.material(r));
        }
      });
    }
  }

  void write(const ChunkKey& key, const Version& version) {
    ByteWriter out(sent_);
    out.svarint(key.at.x);
    out.svarint(key.at.y);
    out.svarint(key.at.z);
    out.varint(version.seq);
  }

  void send(const ShownPatch& patch) {
    REQUIRE(validate(patch.patch));
    REQUIRE_FALSE(patch.patch.empty());
    for (const VeilSpan& span : patch.patch.spans) {
      for (VoxelIndex i = span.first; i < span.first + span.count; ++i)
        told_.at(patch.key.at)[i] = true;
    }
    write(patch.key, patch.after);
    ByteWriter out(sent_);
    write_patch_bytes(patch.patch, out);
    for (ShownReplica& replica : replicas_) {
      ShownReplica::Held& held = replica.chunks.at(patch.key);
      if (held.version != patch.before) is_gap_ = true;
      apply_patch(patch.patch, held.voxels);
      held.version = patch.after;
    }
  }

  EditDescriptor random_edit() {
    const VoxelPos origin = origin_of(any_chunk().at, kEdge);
    EditDescriptor edit;
    if (rng_.below(6) == 0) {
      do {
        edit = random_edit_near(rng_, origin, Extent::cube(kEdge));
      } while (authority_.check(edit));
    } else {
      // Many edits lie at the border of chunks.
      const auto one = [&] { return rng_.below(4) == 0 ? kEdge - 1 : rng_.between(0, kEdge - 1); };
      const std::int32_t x = origin.x + one(), y = origin.y + one(), z = origin.z + one();
      const VoxelPos at{x, y, z};
      edit.material = rng_.below(2) == 0 ? kEmpty : static_cast<Material>(rng_.below(8));
      edit.shape = SetVoxel{at};
      if (rng_.below(3) == 0) edit.shape = FillBox{{at, {at.x + 2, at.y + 1, at.z + 3}}};
      if (rng_.below(6) == 0) {
        edit.shape = FillBox{{at, {at.x + 6, at.y + 6, at.z + 6}}};
        edit.mask = {MaskKind::only_material, kOre};
      }
    }
    // The twin worlds must have equal voxels but for those that are never uncovered.
    if (!has_masks_ && edit.mask.kind == MaskKind::only_material) edit.mask = {};
    return edit;
  }

  /// Orders one to three edits, and sends them.
  void commit() {
    const std::uint32_t count = 1 + rng_.below(3);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Cause cause = rng_.below(5) == 0 ? Cause::undo : Cause::player;
      EditOffer offer{{1, 7, ++seq_}, cause, 0, random_edit()};
      if (cause == Cause::undo) offer.subject = 0;
      CAPTURE(offer.edit);
      REQUIRE(authority_.enqueue(offer).has_value());
    }
    const auto batch = authority_.commit({0, 0});
    REQUIRE(batch.has_value());
    note_open();
    const std::vector<ShownEdit> edits = shown_.apply(*batch);
    REQUIRE(edits.size() == batch->commit.edits.size());
    for (std::size_t i = 0; i < edits.size(); ++i)
      send(edits[i], batch->commit.edits[i], batch->touched[i], batch->commit.epoch);
  }

  void send(const ShownEdit& edit, const OrderedEdit& ordered, const std::vector<ChunkKey>& touched,
            Epoch epoch) {
    ++forms_[static_cast<std::size_t>(edit.form)];
    if (edit.form == ShownForm::hidden) {
      CHECK(edit.patches.empty());
      return;
    }
    ByteWriter(sent_).varint(ordered.seq);
    const bool is_wrong = sabotage_ == VeilSabotage::sends_mask_as_it_is &&
                          ordered.edit.mask.kind == MaskKind::only_material;
    if (edit.form == ShownForm::descriptor || is_wrong) {
      const Bytes bytes = encode(ordered.edit);
      sent_.insert(sent_.end(), bytes.begin(), bytes.end());
      for (std::size_t c = 0; c < touched.size(); ++c) {
        const ChunkKey& key = touched[c];
        for (VoxelIndex i = 0; i < kEdge * kEdge * kEdge; ++i) {
          const VoxelPos p = dense_pos(Extent::cube(kEdge), kVeilOrder, i);
          const VoxelPos origin = origin_of(key.at, kEdge);
          if (told_.contains(key.at) &&
              oracle_covers(ordered.edit, {origin.x + p.x, origin.y + p.y, origin.z + p.z}))
            told_.at(key.at)[i] = true;
        }
        for (ShownReplica& replica : replicas_) {
          const auto found = replica.chunks.find(key);
          if (found == replica.chunks.end()) continue;
          ShownReplica::Held& held = found->second;
          if (!is_wrong && held.version.seq != edit.previous[c]) is_gap_ = true;
          Digest digest;
          apply_stack(held.voxels, digest, origin_of(key.at, kEdge), {&ordered.edit, 1}, apply_);
          if (!is_wrong) held.version = {epoch, ordered.seq};
        }
      }
      if (is_wrong) return;
    }
    for (const ShownPatch& patch : edit.patches) {
      const bool is_touched = std::ranges::find(touched, patch.key) != touched.end();
      if (!is_touched && sabotage_ == VeilSabotage::forgets_neighbours) continue;
      send(patch);
    }
  }

  /// Notes the voxels of the chunks in memory that are not enclosed now.
  void note_open() {
    for (const auto& [at, voxels] : stored_) {
      const ChunkPtr truth = chunks().find({0, at});
      if (truth == nullptr) continue;
      const DenseScene scene = DenseScene::of(truth->voxels, beyond(at));
      for (VoxelIndex i = 0; i < truth->voxels.volume(); ++i) {
        const VoxelPos p = dense_pos(truth->voxels.extent, kVeilOrder, i);
        if (!oracle_encloses(scene, p, rules_)) ever_open_.insert({at, i});
      }
    }
  }

  static EditLimits limits() {
    EditLimits out;
    out.chunk_edge = kEdge;
    out.material_count = 8;
    out.volume_max = 50'000;
    return out;
  }

  SplitMix64 rng_;
  SplitMix64 own_{1};  // of the replicas
  const VeilSabotage sabotage_;
  const bool has_masks_;
  const VeilOracleRules rules_{covers_in_veil, true, kStone};
  Authority authority_{limits(), {1, 0, 0}};
  ShownChunks shown_{authority_.chunks(), kEdge, mesh_materials()};
  std::map<ChunkCoord, RunChunk> stored_;
  std::map<ChunkKey, Version> saved_;
  std::array<ShownReplica, 4> replicas_;
  Dense made_;  // the shown chunks when they were made
  Told told_;   // since then
  std::set<std::pair<ChunkCoord, VoxelIndex>> ever_open_;
  ApplyScratch apply_;
  ClientSequence seq_ = 0;
  Bytes sent_;
  std::array<int, 3> forms_{};
  int arrivals_ = 0;
  bool is_gap_ = false;
};

}  // namespace

TEST_CASE("veiled replicas hold the shown chunks, and these hide what was never uncovered",
          "[world][veil][property]") {
  int hidden = 0, descriptors = 0, results = 0, arrivals = 0;
  for (std::uint64_t round = 0; round < 4; ++round) {
    const std::uint64_t seed = mix64(Catch::rngSeed() + round);
    CAPTURE(Catch::rngSeed(), round);
    SplitMix64 rng{seed};
    ShownWorld world(seed, ore_ground(rng), VeilSabotage::none, true);
    for (int step = 0; step < 40; ++step) {
      world.step();
      CAPTURE(step);
      if (step % 4 == 0) REQUIRE(world.mismatch() == "");
    }
    REQUIRE(world.mismatch() == "");
    hidden += world.count_of(ShownForm::hidden);
    descriptors += world.count_of(ShownForm::descriptor);
    results += world.count_of(ShownForm::result);
    arrivals += world.arrivals();
  }
  CHECK(hidden > 10);
  CHECK(descriptors > 10);
  CHECK(results > 10);
  CHECK(arrivals > 0);
}

TEST_CASE("no byte that a veiled session gets depends on ore that was never uncovered",
          "[world][veil][property]") {
  for (std::uint64_t round = 0; round < 2; ++round) {
    const std::uint64_t seed = mix64(Catch::rngSeed() + 100 + round);
    CAPTURE(Catch::rngSeed(), round);
    SplitMix64 rng{seed};
    const Ground ground = ore_ground(rng);
    const auto run = [&](const Ground& first, VeilSabotage sabotage) {
      auto world = std::make_unique<ShownWorld>(seed, first, sabotage, false);
      for (int step = 0; step < 25; ++step) world->step();
      return world;
    };
    const auto world = run(ground, VeilSabotage::none);
    CHECK(world->never_open() > 1'000);
    SplitMix64 other{seed + 1};
    const Ground twin = world->with_other_ore(ground, other);
    REQUIRE_FALSE(twin == ground);
    CHECK(run(twin, VeilSabotage::none)->sent() == world->sent());
    // The comparison finds a server that sends the truth.
    CHECK_FALSE(run(twin, VeilSabotage::sends_truth)->sent() ==
                run(ground, VeilSabotage::sends_truth)->sent());
  }
}

TEST_CASE("a server that breaks the rule of shown chunks is caught", "[world][veil][property]") {
  for (const VeilSabotage sabotage :
       {VeilSabotage::sends_truth, VeilSabotage::forgets_neighbours,
        VeilSabotage::sends_mask_as_it_is, VeilSabotage::forgets_arrivals}) {
    CAPTURE(static_cast<int>(sabotage));
    bool is_caught = false;
    for (std::uint64_t round = 0; round < 16 && !is_caught; ++round) {
      const std::uint64_t seed = mix64(Catch::rngSeed() + 200 + round);
      SplitMix64 rng{seed};
      ShownWorld world(seed, ore_ground(rng), sabotage, true);
      for (int step = 0; step < 30 && !is_caught; ++step) {
        world.step();
        is_caught = !world.mismatch().empty();
      }
    }
    CHECK(is_caught);
  }
}

}  // namespace runstone::test
