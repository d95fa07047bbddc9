#include "client/render/light_flood.hpp"

#include <algorithm>

namespace runstone {

void LightFlood::reset(int size_x, int size_y, int size_z) {
  stride_y_ = static_cast<std::size_t>(size_x);
  stride_z_ = stride_y_ * static_cast<std::size_t>(size_y);
  const std::size_t volume = stride_z_ * static_cast<std::size_t>(size_z);
  // A large box is rare, and its memory is not kept for the small ones of edits.
  constexpr std::size_t kKept = 1U << 20;
  if (levels_.capacity() > std::max(kKept, 16 * volume)) {
    voxels_ = {};
    levels_ = {};
  }
  voxels_.assign(volume, Voxel{});
  levels_.assign(volume, 0);
}

void LightFlood::run() {
  for (std::size_t level = kLightMax; level > kFaceStep; --level) {
    // A voxel is never added to the list of the present level, because each step takes light.
    for (const std::uint32_t i : waiting_[level]) spread(i);
    waiting_[level].clear();
  }
}

void LightFlood::spread(std::size_t i) {
  const LightLevels from = levels_[i];
  const std::array<std::size_t, 3> strides = {1, stride_y_, stride_z_};
  std::array<bool, 6> is_open{};  // of the neighbours along -x, +x, -y, +y, -z, +z
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
      const std::size_t at = side == 0 ? i - strides[axis] : i + strides[axis];
      is_open[2 * axis + side] = voxels_[at].pass != LightPass::opaque;
      light(at, from, kFaceStep);
    }
  }
  for (std::size_t a = 0; a < 2; ++a) {
    for (std::size_t b = a + 1; b < 3; ++b) {
      for (std::size_t sides = 0; sides < 4; ++sides) {
        const std::size_t side_a = sides & 1U, side_b = sides >> 1;
        if (!is_open[2 * a + side_a] && !is_open[2 * b + side_b]) continue;
        const std::size_t past_a = side_a == 0 ? i - strides[a] : i + strides[a];
        light(side_b == 0 ? past_a - strides[b] : past_a + strides[b], from, kEdgeStep);
      }
    }
  }
}

void LightFlood::light(std::size_t i, LightLevels from, std::uint32_t step) {
  const Voxel voxel = voxels_[i];
  if (voxel.is_fixed || voxel.pass == LightPass::opaque) return;
  const LightLevels before = levels_[i];
  const LightLevels after = brighter(before, dimmed(from, step + loss_of(voxel.pass)));
  if (after == before) return;
  levels_[i] = after;
  // The bytes that grew decide when the voxel spreads its light again.
  std::uint32_t grown = 0;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    const std::uint32_t level = after >> shift & 255U;
    if (level != (before >> shift & 255U)) grown = std::max(grown, level);
  }
  push(i, grown);
}

}  // namespace runstone
