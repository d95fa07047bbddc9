// Shown chunks and true chunks under random edits: they differ only in enclosed voxels, and the
// sent data reveals nothing about voxels that were always enclosed when it was sent.
#include "common/veil/uncovered.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "common/edits/apply/edit_stack.hpp"
#include "common/runs/reorder.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/support/veil/veil_oracle.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kWorldSide = 2;  // chunks along each axis

/// The chunk that a client holds, in an axis order of its own.
struct VeiledReplica {
  RunChunk voxels;
  Digest digest;
};

struct VeiledChunk {
  explicit VeiledChunk(RunChunk ground) : truth(std::move(ground)), first(truth.extent) {}

  RunChunk truth, shown;  // in one axis order
  std::array<VeiledReplica, 2> replicas;
  DenseChunk first;           // the first shown chunk
  std::vector<bool> is_told;  // of the voxels in the order kVeilOrder: by an edit or a patch since
};

bool covers(Material material) { return mesh_visibility()[material] == Visibility::opaque; }

class VeiledWorld {
 public:
  VeiledWorld(SplitMix64& rng, std::int32_t edge) : rng_(rng), edge_(edge) {
    for (std::int32_t z = 0; z < kWorldSide; ++z)
      for (std::int32_t y = 0; y < kWorldSide; ++y)
        for (std::int32_t x = 0; x < kWorldSide; ++x) {
          const Extent extent = Extent::cube(static_cast<unsigned>(edge));
          RunChunk ground = uniform_chunk(extent, kStone, random_order(rng));
          for (int i = 0; i < 30; ++i)
            fill(ground, rng.below(ground.volume()), 1, static_cast<Material>(6 + rng.below(2)));
          for (int i = 0; i < 3; ++i) fill(ground, rng.below(ground.volume() - 4), 4, kEmpty);
          chunks_.emplace(ChunkCoord{x, y, z}, VeiledChunk(std::move(ground)));
        }
    for (auto& [at, chunk] : chunks_) {
      const RunChunk veil = veil_of(chunk.truth, beyond(at), materials_, scratch_);
      chunk.shown = reorder(veil, chunk.truth.order);
      for (VeiledReplica& replica : chunk.replicas)
        replica = {reorder(veil, random_order(rng)), digest_of(veil)};
      chunk.first = DenseChunk::of(veil);
      chunk.is_told.assign(veil.volume(), false);
    }
  }

  /// Orders an edit. If `by_result`, veiled sessions get the changes of the shown chunk in place of
  /// the descriptor.
  void order(const EditDescriptor& edit, bool by_result) {
    std::map<ChunkCoord, DirtyLayers> dirty;
    for (auto& [at, chunk] : chunks_) {
      Digest digest = digest_of(chunk.truth);
      dirty[at] =
          apply_stack(chunk.truth, digest, origin_of(at, edge_), std::span(&edit, 1), apply_).dirty;
    }
    // An edit that changes no shown voxel is not sent.
    bool is_seen = false;
    for (auto& [at, chunk] : chunks_)
      is_seen = !uncovered(at, all_slow_layers(chunk.truth)).empty() || is_seen;
    if (is_seen && !by_result) send(edit);
    sent_ += is_seen ? 1 : 0;
    hidden_ += is_seen ? 0 : 1;
    for (auto& [at, chunk] : chunks_) {
      std::array<DirtyLayers, kDirectionCount> around;
      for (std::size_t d = 0; d < around.size(); ++d) {
        const auto found = dirty.find(neighbour(at, static_cast<Direction>(d)));
        if (found != dirty.end()) around[d] = found->second;
      }
      patch(at, layers_beside(chunk.truth, dirty[at], around));
    }
  }

  void check() {
    for (auto& [at, chunk] : chunks_) {
      CAPTURE(at.x, at.y, at.z);
      REQUIRE(validate(chunk.shown));
      // No layer was forgotten.
      REQUIRE(uncovered(at, all_slow_layers(chunk.truth)).empty());
      const DenseScene scene = DenseScene::of(chunk.truth, beyond(at));
      const DenseChunk shown = DenseChunk::of(chunk.shown);
      const VeilOracleRules rules{covers, true, materials_.filler};
      for (VoxelIndex i = 0; i < chunk.shown.volume(); ++i) {
        const VoxelPos p = dense_pos(shown.extent(), kVeilOrder, i);
        const Material is = scene.chunk.at(p.x, p.y, p.z), seen = shown.at(p.x, p.y, p.z);
        if (is != seen) REQUIRE((covers(seen) && oracle_encloses(scene, p, rules)));
        if (!chunk.is_told[i]) REQUIRE(seen == chunk.first.at(p.x, p.y, p.z));
      }
      for (const VeiledReplica& replica : chunk.replicas) {
        REQUIRE(validate(replica.voxels));
        REQUIRE(digest_of(replica.voxels) == digest_of(chunk.shown));
      }
    }
  }

  Extent extent() const { return Extent::cube(static_cast<unsigned>(edge_)); }
  ChunkCoord any() {
    const auto one = [&] { return static_cast<std::int32_t>(rng_.below(kWorldSide)); };
    return {one(), one(), one()};
  }
  int sent() const { return sent_; }
  int hidden() const { return hidden_; }
  int patches() const { return patches_; }

 private:
  std::array<const RunChunk*, kDirectionCount> beyond(ChunkCoord at) const {
    std::array<const RunChunk*, kDirectionCount> out{};
    for (std::size_t d = 0; d < out.size(); ++d) {
      const auto found = chunks_.find(neighbour(at, static_cast<Direction>(d)));
      if (found != chunks_.end()) out[d] = &found->second.truth;
    }
    return out;
  }

  VeilPatch uncovered(ChunkCoord at, SlowLayers layers) {
    const VeiledChunk& chunk = chunks_.at(at);
    const VeilBorders borders(chunk.truth, beyond(at), materials_.covers, MissingSide::closed,
                              layers);
    VeilPatch patch;
    find_uncovered(chunk.truth, borders, chunk.shown, materials_, layers, scratch_, patch);
    return patch;
  }

  /// Applies the descriptor to the shown chunks.
  void send(const EditDescriptor& edit) {
    for (auto& [at, chunk] : chunks_) {
      const VoxelPos origin = origin_of(at, edge_);
      for (VoxelIndex i = 0; i < chunk.shown.volume(); ++i) {
        const VoxelPos p = dense_pos(chunk.shown.extent, kVeilOrder, i);
        if (oracle_writes(edit, {p.x + origin.x, p.y + origin.y, p.z + origin.z}))
          chunk.is_told[i] = true;
      }
      Digest digest = digest_of(chunk.shown);
      apply_stack(chunk.shown, digest, origin, std::span(&edit, 1), apply_);
      for (VeiledReplica& replica : chunk.replicas)
        apply_stack(replica.voxels, replica.digest, origin, std::span(&edit, 1), apply_);
    }
  }

  /// Sends the voxels that are uncovered in the layers.
  void patch(ChunkCoord at, SlowLayers layers) {
    VeiledChunk& chunk = chunks_.at(at);
    const VeilPatch patch = in_order(uncovered(at, layers), kVeilOrder);
    REQUIRE(validate(patch));
    if (patch.empty()) return;
    ++patches_;
    const DenseScene scene = DenseScene::of(chunk.truth, beyond(at));
    for (const VeilSpan& span : patch.spans) {
      for (VoxelIndex i = span.first; i < span.first + span.count; ++i) {
        const VoxelPos p = dense_pos(chunk.truth.extent, kVeilOrder, i);
        const VeilOracleRules rules{covers, true, materials_.filler};
        REQUIRE(
            span.material ==
            (oracle_encloses(scene, p, rules) ? materials_.filler : scene.chunk.at(p.x, p.y, p.z)));
        chunk.is_told[i] = true;
      }
    }
    CHECK(apply_patch(patch, chunk.shown));
    for (VeiledReplica& replica : chunk.replicas) CHECK(apply_patch(patch, replica.voxels));
  }

  SplitMix64& rng_;
  const std::int32_t edge_;
  const VeilMaterials materials_{mesh_visibility(), kStone};
  std::map<ChunkCoord, VeiledChunk> chunks_;
  VeilScratch scratch_;
  ApplyScratch apply_;
  int sent_ = 0, hidden_ = 0, patches_ = 0;
};

/// Returns an edit of few voxels, most often one: such edits dig and hide.
EditDescriptor small_edit(SplitMix64& rng, VoxelPos origin, std::int32_t edge) {
  const auto side = static_cast<std::uint32_t>(edge);
  const VoxelPos at{origin.x + static_cast<std::int32_t>(rng.below(side)),
                    origin.y + static_cast<std::int32_t>(rng.below(side)),
                    origin.z + static_cast<std::int32_t>(rng.below(side))};
  EditDescriptor out;
  out.material = static_cast<Material>(rng.below(8));
  if (rng.below(3) != 0) {
    out.shape = SetVoxel{at};
  } else {
    out.shape = FillBox{{at, {at.x + 2, at.y + 1, at.z + 3}}};
  }
  if (rng.below(4) == 0) {
    out.mask = {MaskKind::only_material, static_cast<Material>(rng.below(8))};
  }
  return out;
}

}  // namespace

TEST_CASE("what veiled replicas hold differs from the truth in enclosed voxels alone",
          "[veil][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  int sent = 0, hidden = 0, patches = 0;
  for (const std::int32_t edge : {8, 8, 8, 16}) {
    VeiledWorld world(rng, edge);
    world.check();
    const int steps = edge == 8 ? 120 : 30;
    for (int step = 0; step < steps; ++step) {
      const VoxelPos origin = origin_of(world.any(), edge);
      const EditDescriptor edit = rng.below(6) == 0 ? random_edit_near(rng, origin, world.extent())
                                                    : small_edit(rng, origin, edge);
      CAPTURE(Catch::rngSeed(), edge, step, edit);
      // A replica would apply a mask for a material to its own voxels.
      world.order(edit, edit.mask.kind == MaskKind::only_material || rng.below(3) == 0);
      world.check();
    }
    sent += world.sent();
    hidden += world.hidden();
    patches += world.patches();
  }
  CHECK(sent > 50);
  CHECK(hidden > 10);
  CHECK(patches > 50);
}

TEST_CASE("a mask for a material parts truth and veil, unless the result is sent",
          "[veil][property]") {
  // The edit replaces ore by water in rock. In the shown chunk it would find no ore.
  const Extent extent = Extent::cube(8);
  RunChunk truth = uniform_chunk(extent, kStone, kVeilOrder);
  const VoxelIndex ore = index_of({4, 4, 4}, extent, kVeilOrder);
  fill(truth, ore, 1, 6);
  const VeilMaterials materials{mesh_visibility(), kStone};
  VeilScratch scratch;
  ApplyScratch apply;
  RunChunk shown = veil_of(truth, {}, materials, scratch);
  CHECK(shown.is_uniform());
  EditDescriptor edit{FillBox{{{0, 0, 0}, {8, 8, 8}}}, {MaskKind::only_material, 6}, kWater};
  Digest digest = digest_of(truth), of_shown = digest_of(shown);
  CHECK(apply_stack(truth, digest, {}, std::span(&edit, 1), apply).changed);
  CHECK_FALSE(apply_stack(shown, of_shown, {}, std::span(&edit, 1), apply).changed);
  const VeilBorders borders(truth, {}, materials.covers, MissingSide::closed);
  VeilPatch patch;
  find_uncovered(truth, borders, shown, materials, all_slow_layers(truth), scratch, patch);
  CHECK(patch.spans == std::vector<VeilSpan>{{ore, 1, kWater}});
  REQUIRE(apply_patch(patch, shown));
  CHECK(shown == truth);
}

TEST_CASE("an edit in a neighbour uncovers the border of a chunk", "[veil][property]") {
  const Extent extent = Extent::cube(8);
  const RunChunk truth = [&] {
    RunChunk chunk = uniform_chunk(extent, kStone, AxisOrder::yxz);
    fill(chunk, index_of({0, 3, 5}, extent, AxisOrder::yxz), 1, 6);
    return chunk;
  }();
  RunChunk beside = uniform_chunk(extent, kStone, AxisOrder::xyz);
  const VeilMaterials materials{mesh_visibility(), kStone};
  VeilScratch scratch;
  std::array<const RunChunk*, kDirectionCount> beyond{};
  beyond[static_cast<std::size_t>(Direction::neg_x)] = &beside;
  RunChunk shown = reorder(veil_of(truth, beyond, materials, scratch), truth.order);
  CHECK(shown.is_uniform());
  std::array<DirtyLayers, kDirectionCount> dirty;
  dirty[static_cast<std::size_t>(Direction::neg_x)] =
      fill_and_mark(beside, index_of({7, 3, 5}, extent, AxisOrder::xyz), 1, kEmpty);
  const SlowLayers layers = layers_beside(truth, {}, dirty);
  CHECK(layers == SlowLayers{5, 6});
  VeilPatch patch;
  const VeilBorders borders(truth, beyond, materials.covers, MissingSide::closed, layers);
  find_uncovered(truth, borders, shown, materials, layers, scratch, patch);
  REQUIRE(patch.spans.size() == 1);
  CHECK(patch.spans[0] == VeilSpan{index_of({0, 3, 5}, extent, truth.order), 1, 6});
  // An edit that does not touch the chunk uncovers nothing in it.
  dirty[static_cast<std::size_t>(Direction::neg_x)] =
      fill_and_mark(beside, index_of({5, 3, 5}, extent, AxisOrder::xyz), 1, kEmpty);
  CHECK(layers_beside(truth, {}, dirty).empty());
}

}  // namespace runstone::test
