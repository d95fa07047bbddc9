#include "common/mesh/shapes/beyond_border.hpp"

#include "common/runs/layer.hpp"

namespace runstone::shape_mesh {

void BeyondBorder::begin(const RunChunk& chunk, const MeshNeighbours& neighbours) {
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const Axis axis = axis_of(static_cast<Direction>(i));
    Side& side = sides_[i];
    side.chunk = neighbours[i];
    side.u_shift = place_shift(u_axis_of(axis));
    side.v_shift = place_shift(v_axis_of(axis));
    side.width = chunk.extent.sides()[static_cast<std::size_t>(u_axis_of(axis))];
    side.lookups = 0;
    side.layer.clear();
  }
}

Material BeyondBorder::look_up(Direction d, std::uint8_t u, std::uint8_t v) {
  Side& side = sides_[static_cast<std::size_t>(d)];
  if (side.chunk == nullptr) return kEmpty;
  const RunChunk& chunk = *side.chunk;
  if (chunk.is_uniform()) return chunk.runs.material(0);
  const Axis axis = axis_of(d), u_axis = u_axis_of(axis), v_axis = v_axis_of(axis);
  const auto sides = chunk.extent.sides();
  const auto layer =
      static_cast<std::uint8_t>(is_positive(d) ? 0 : sides[static_cast<std::size_t>(axis)] - 1);
  if (side.lookups++ < kLookups) {
    std::array<std::uint8_t, 3> at{};
    at[static_cast<std::size_t>(axis)] = layer;
    at[static_cast<std::size_t>(u_axis)] = u;
    at[static_cast<std::size_t>(v_axis)] = v;
    return material_at(chunk, {at[0], at[1], at[2]});
  }
  side.layer.resize(std::size_t{side.width} * sides[static_cast<std::size_t>(v_axis)]);
  read_layer(chunk, axis, layer, u_axis, side.layer);
  return side.layer[u + std::size_t{side.width} * v];
}

}  // namespace runstone::shape_mesh
