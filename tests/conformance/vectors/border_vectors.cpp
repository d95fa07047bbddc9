#include <array>
#include <utility>
#include <vector>

#include "common/runs/layer.hpp"
#include "tests/conformance/vectors/vector_values.hpp"

namespace runstone::conformance {
namespace {

/// Returns the outermost layer of the chunk in a direction, row by row: first the axis of the two
/// others that comes first in x, y, z. Stretches of one material are pairs of length and material.
Json layer_of(const RunChunk& chunk, Direction direction) {
  const Axis across = axis_of(direction);
  const Axis u = across == Axis::x ? Axis::y : Axis::x;
  const Axis v = across == Axis::z ? Axis::y : Axis::z;
  const auto sides = chunk.extent.sides();
  const auto side = [&](Axis axis) { return std::uint32_t{sides[static_cast<std::size_t>(axis)]}; };
  std::vector<Material> layer(std::size_t{side(u)} * side(v));
  read_layer(chunk, across, is_positive(direction) ? side(across) - 1 : 0, u, layer);
  Json out = Json::array();
  for (std::size_t first = 0; first < layer.size();) {
    std::size_t end = first;
    while (end < layer.size() && layer[end] == layer[first]) ++end;
    out.push_back({end - first, layer[first]});
    first = end;
  }
  return out;
}

}  // namespace

Json border_vectors() {
  static constexpr std::array<const char*, kDirectionCount> kNames = {"-x", "+x", "-y",
                                                                      "+y", "-z", "+z"};
  Json chunks = Json::array();
  for (const auto& [name, chunk] :
       {std::pair{"ground", ground_chunk({0, 0, 0}, 16, AxisOrder::zxy)},
        std::pair{"one material", uniform_chunk({8, 16, 24}, 9)},
        std::pair{"ground at negative keys", ground_chunk({-2, 0, -3}, 16, AxisOrder::xyz)}}) {
    Json layers;
    for (int d = 0; d < kDirectionCount; ++d)
      layers[kNames[static_cast<std::size_t>(d)]] = layer_of(chunk, static_cast<Direction>(d));
    chunks.push_back({{"name", name}, {"raw", raw_hex(chunk)}, {"layers", std::move(layers)}});
  }
  return {{"format", "runstone border vectors 1"}, {"chunks", std::move(chunks)}};
}

}  // namespace runstone::conformance
