#include "bench/edits/rights_case.hpp"

#include <algorithm>
#include <string>

#include "bench/harness/clocks.hpp"
#include "common/core/assert.hpp"
#include "common/core/hash.hpp"
#include "common/rights/rights_state.hpp"

namespace runstone::bench {
namespace {

constexpr std::int32_t kLandSide = 20'000;  // voxels
constexpr std::uint32_t kOwners = 400;

PublicKey owner(std::uint32_t number) {
  PublicKey key{};
  key[0] = static_cast<std::uint8_t>(number);
  key[1] = static_cast<std::uint8_t>(number >> 8);
  return key;
}

VoxelPos any_place(SplitMix64& rng) {
  return {rng.between(0, kLandSide), rng.between(-60, 200), rng.between(0, kLandSide)};
}

ProtectedBox any_box(SplitMix64& rng, Ground ground, std::size_t number) {
  ProtectedBox out;
  out.name = "box-" + std::to_string(number);
  out.owner = owner(rng.below(kOwners));
  const bool is_region = ground == Ground::nested && number % 20 == 0;
  const std::int32_t half = is_region ? rng.between(500, 3'000) : rng.between(4, 32);
  const VoxelPos c = any_place(rng);
  out.box = {{c.x - half, c.y - half, c.z - half}, {c.x + half, c.y + half, c.z + half}};
  if (number % 3 == 0) {
    out.box.min.y = -kWorldLimit;
    out.box.max.y = kWorldLimit;
  }
  return out;
}

}  // namespace

std::vector<double> time_rights(Ground ground, std::size_t boxes, std::size_t decisions,
                                unsigned repetitions) {
  SplitMix64 rng(11);
  RightsState state;
  for (std::size_t i = 0; i < boxes; ++i)
    state.apply(Protect{any_box(rng, ground, i)}, {i + 1, 0, 0});
  std::vector<double> us;
  std::size_t allowed = 0;
  for (unsigned r = 0; r < repetitions; ++r) {
    std::vector<VoxelPos> places(decisions);
    for (VoxelPos& place : places) place = any_place(rng);
    const std::uint64_t start_ns = now_ns();
    for (std::size_t i = 0; i < decisions; ++i) {
      const VoxelPos at = places[i];
      const VoxelBox voxel{at, {at.x + 1, at.y + 1, at.z + 1}};
      const PublicKey player = owner(static_cast<std::uint32_t>(i) % (2 * kOwners));
      const auto touches = [at](const VoxelBox& box) { return box.contains(at); };
      allowed += state.decide_edit(player, voxel, touches, 0).is_allowed ? 1 : 0;
    }
    us.push_back(static_cast<double>(now_ns() - start_ns) / 1e3);
  }
  RUNSTONE_ASSERT(allowed < decisions * repetitions);  // some lie in boxes of others
  return us;
}

}  // namespace runstone::bench
