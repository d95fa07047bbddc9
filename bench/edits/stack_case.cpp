#include "bench/edits/stack_case.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <utility>

#include "bench/harness/clocks.hpp"
#include "bench/worlds/seeded_worlds.hpp"
#include "common/core/assert.hpp"
#include "common/core/hash.hpp"
#include "common/edits/apply/edit_stack.hpp"

namespace runstone::bench {
namespace {

constexpr std::int32_t kStackEdge = 32;

Mask draw_mask(SplitMix64& rng) {
  if (rng.below(10) >= 3) return {};
  switch (rng.below(3)) {
    case 0:
      return {MaskKind::only_empty, kEmpty};
    case 1:
      return {MaskKind::only_solid, kEmpty};
    default:
      return {MaskKind::only_material, static_cast<Material>(1 + rng.below(5))};
  }
}

VoxelPos draw_place(SplitMix64& rng) {
  return {rng.between(0, kStackEdge - 1), rng.between(0, kStackEdge - 1),
          rng.between(0, kStackEdge - 1)};
}

EditShape draw_box(SplitMix64& rng, std::int32_t side_max) {
  const VoxelPos at = draw_place(rng);
  const auto side = [&] { return rng.between(1, side_max); };
  return FillBox{{at, {at.x + side(), at.y + side(), at.z + side()}}};
}

EditShape draw_by_hand(SplitMix64& rng) {
  switch (rng.below(10)) {
    case 0:
      return draw_box(rng, 4);
    case 1:
      return FillSphere{draw_place(rng), static_cast<std::uint16_t>(rng.between(1, 2))};
    case 2: {
      const VoxelPos at = draw_place(rng);
      return FillStroke{
          {at, {at.x + rng.between(1, 6), at.y + rng.between(-1, 1), at.z + rng.between(0, 6)}}, 1};
    }
    default:
      return SetVoxel{draw_place(rng)};
  }
}

EditShape draw_by_brush(SplitMix64& rng) {
  switch (rng.below(10)) {
    case 0:
    case 1:
      return draw_box(rng, 8);
    case 2:
    case 3:
      return FillSphere{draw_place(rng), static_cast<std::uint16_t>(rng.between(1, 6))};
    case 4:
    case 5: {
      FillStroke stroke{{draw_place(rng)}, static_cast<std::uint16_t>(rng.between(1, 2))};
      const std::size_t points = 2 + rng.below(2);
      while (stroke.points.size() < points) {
        const VoxelPos next = draw_place(rng);
        if (next != stroke.points.back()) stroke.points.push_back(next);
      }
      return stroke;
    }
    default:
      return SetVoxel{draw_place(rng)};
  }
}

const VoxelWorld& terrain() {
  static const std::vector<VoxelWorld> worlds = seeded_worlds();
  return *std::find_if(worlds.begin(), worlds.end(),
                       [](const VoxelWorld& world) { return world.name == "terrain"; });
}

double us_since(std::uint64_t start_ns) { return static_cast<double>(now_ns() - start_ns) / 1000; }

}  // namespace

std::vector<EditDescriptor> mixed_edits(EditMix mix, std::uint64_t seed, std::size_t count) {
  SplitMix64 rng(seed);
  std::vector<EditDescriptor> edits;
  while (edits.size() < count) {
    EditShape shape = mix == EditMix::by_hand ? draw_by_hand(rng) : draw_by_brush(rng);
    edits.push_back({std::move(shape), draw_mask(rng), static_cast<Material>(rng.below(8))});
  }
  return edits;
}

Chunk terrain_chunk(ChunkCoord at) {
  Chunk chunk;
  chunk.voxels =
      chunk_of_world(terrain(), origin_of(at, kStackEdge), static_cast<unsigned>(kStackEdge));
  chunk.digest = digest_of(chunk.voxels);
  return chunk;
}

StackTiming time_stack(const Chunk& chunk, const std::vector<EditDescriptor>& edits,
                       unsigned repetitions) {
  StackTiming timing;
  ApplyScratch scratch;
  ApplyResult result;
  for (unsigned i = 0; i <= repetitions; ++i) {
    Chunk stacked = chunk, one_by_one = chunk;
    const std::uint64_t start = now_ns();
    apply_stack(stacked.voxels, stacked.digest, {}, edits, scratch, result);
    const double stacked_us = us_since(start);
    const std::uint64_t second = now_ns();
    for (const EditDescriptor& edit : edits) {
      apply_stack(one_by_one.voxels, one_by_one.digest, {}, std::span(&edit, 1), scratch, result);
    }
    const double one_by_one_us = us_since(second);
    RUNSTONE_ASSERT(stacked == one_by_one);
    if (i == 0) continue;  // the first repetition grows the buffers
    timing.stacked_us.push_back(stacked_us);
    timing.one_by_one_us.push_back(one_by_one_us);
  }
  return timing;
}

SpreadTiming time_spread(const EditDescriptor& edit, unsigned repetitions) {
  SpreadTiming timing;
  std::map<ChunkCoord, Chunk> land;
  for (const ChunkCoord at : touched_chunks(edit, kStackEdge)) land.emplace(at, terrain_chunk(at));
  timing.chunks = land.size();
  ApplyScratch scratch;
  ApplyResult result;
  for (unsigned i = 0; i <= repetitions; ++i) {
    auto chunks = land;
    const std::uint64_t start = now_ns();
    for (const ChunkCoord at : touched_chunks(edit, kStackEdge)) {
      Chunk& chunk = chunks.at(at);
      apply_stack(chunk.voxels, chunk.digest, origin_of(at, kStackEdge), std::span(&edit, 1),
                  scratch, result);
    }
    if (i != 0) timing.us.push_back(us_since(start));
  }
  return timing;
}

}  // namespace runstone::bench
