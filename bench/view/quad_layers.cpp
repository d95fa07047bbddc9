#include "bench/view/quad_layers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace runstone::bench {
namespace {

/// Returns the index of the quad's layer in QuadLayers::first.
std::size_t layer_of(Quad quad) {
  const QuadFields fields = unpack(quad);
  const std::array<std::uint8_t, 3> at = {fields.x, fields.y, fields.z};
  return static_cast<std::size_t>(fields.direction) * kSideMax +
         at[static_cast<std::size_t>(axis_of(fields.direction))];
}

void sort_into_layers(QuadLayers& layers) {
  std::sort(layers.quads.begin(), layers.quads.end(), [](Quad a, Quad b) {
    const std::size_t of_a = layer_of(a), of_b = layer_of(b);
    return of_a != of_b ? of_a < of_b : a < b;
  });
  std::size_t next = 0;  // the first layer without a start
  for (std::size_t i = 0; i < layers.quads.size(); ++i) {
    for (const std::size_t layer = layer_of(layers.quads[i]); next <= layer; ++next)
      layers.first[next] = static_cast<std::uint32_t>(i);
  }
  for (; next < layers.first.size(); ++next)
    layers.first[next] = static_cast<std::uint32_t>(layers.quads.size());
}

}  // namespace

ChunkMesh layered(std::span<const Quad> quads, const VisibilityTable& visibility) {
  ChunkMesh out;
  for (const Quad quad : quads) {
    const bool is_opaque = visibility[unpack(quad).material] == Visibility::opaque;
    (is_opaque ? out.opaque : out.transparent).quads.push_back(quad);
  }
  sort_into_layers(out.opaque);
  sort_into_layers(out.transparent);
  return out;
}

}  // namespace runstone::bench
