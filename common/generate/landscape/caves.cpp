#include "common/generate/landscape/caves.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "common/core/hash.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kTunnelWidth = 190;  // a tunnel runs where its noise is nearer to zero
constexpr std::array<std::int32_t, kTunnels> kDepths = {38, 15};  // below the surface
constexpr std::int32_t kHeightSwing = 24;

}  // namespace

Caves::Caves(std::uint64_t seed)
    : layers_{Layer{LatticeNoise(mix64(seed + 41), 7), LatticeNoise(mix64(seed + 42), 5),
                    LatticeNoise(mix64(seed + 43), 7)},
              Layer{LatticeNoise(mix64(seed + 44), 7), LatticeNoise(mix64(seed + 45), 5),
                    LatticeNoise(mix64(seed + 46), 7)}} {}

std::array<Tunnel, kTunnels> Caves::at(std::int32_t x, std::int32_t z, std::int32_t surface) const {
  std::array<Tunnel, kTunnels> out;
  for (std::size_t i = 0; i < kTunnels; ++i) {
    const Layer& layer = layers_[i];
    const std::int32_t line = std::abs(layer.wide.at(x, z) + layer.narrow.at(x, z) / 8);
    if (line >= kTunnelWidth) continue;
    const std::int32_t middle = surface - kDepths[i] + layer.height.at(x, z) * kHeightSwing / kOne;
    const std::int32_t half =
        1 + 3 * (kTunnelWidth * kTunnelWidth - line * line) / (kTunnelWidth * kTunnelWidth);
    out[i] = {middle - half, middle + half + 1};
  }
  if (out[0].from >= out[0].to || out[1].from >= out[1].to) return out;
  if (out[1].from < out[0].from) std::swap(out[0], out[1]);
  // Two tunnels that meet are one.
  if (out[1].from <= out[0].to) {
    out[0].to = std::max(out[0].to, out[1].to);
    out[1] = {};
  }
  return out;
}

}  // namespace runstone
