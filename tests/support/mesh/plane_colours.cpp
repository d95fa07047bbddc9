#include "tests/support/mesh/plane_colours.hpp"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "common/core/hash.hpp"
#include "common/mesh/quad.hpp"

namespace runstone {
namespace {

constexpr std::uint32_t kColours = 4000;

MaterialTable make_plane_colours() {
  MaterialTable table;
  SplitMix64 rng(77);
  for (std::uint32_t id = 1; id <= kColours; ++id) {
    const auto channel = [&rng] { return static_cast<std::uint8_t>(40 + 43 * rng.below(6)); };
    // The renderer gives glass neither variation nor grain.
    const MaterialColour colour = {channel(), channel(), channel(), 255};
    if (!table.add({"glass " + std::to_string(id), colour, Visibility::opaque, {}}))
      throw std::logic_error("a material of a plane is refused");
  }
  return table;
}

}  // namespace

const MaterialTable& plane_colours() {
  static const MaterialTable table = make_plane_colours();
  return table;
}

ChunkMesh coloured_by_plane(const ChunkMesh& mesh, VoxelPos origin, bool into_faces) {
  ChunkMesh out;
  for (std::size_t layer = 0; layer + 1 < mesh.opaque.first.size(); ++layer) {
    for (std::size_t i = mesh.opaque.first[layer]; i < mesh.opaque.first[layer + 1]; ++i) {
      QuadFields quad = unpack(mesh.opaque.quads[i]);
      const Axis axis = axis_of(quad.direction);
      const std::array<std::int32_t, 3> place = {origin.x + quad.x, origin.y + quad.y,
                                                 origin.z + quad.z};
      const auto along = static_cast<std::int64_t>(place[static_cast<std::size_t>(axis)]);
      SplitMix64 rng(static_cast<std::uint64_t>(along * 6 + static_cast<int>(quad.direction)));
      quad.material = static_cast<Material>(1 + rng.below(kColours));
      const int columns = into_faces ? quad.width : 1, rows = into_faces ? quad.height : 1;
      if (into_faces) quad.width = quad.height = 1;
      const std::array<std::uint8_t*, 3> from = {&quad.x, &quad.y, &quad.z};
      std::uint8_t& u = *from[static_cast<std::size_t>(u_axis_of(axis))];
      std::uint8_t& v = *from[static_cast<std::size_t>(v_axis_of(axis))];
      const std::uint8_t u0 = u, v0 = v;
      for (int face = 0; face < columns * rows; ++face) {
        u = static_cast<std::uint8_t>(u0 + face % columns);
        v = static_cast<std::uint8_t>(v0 + face / columns);
        out.opaque.quads.push_back(pack(quad));
      }
    }
    out.opaque.first[layer + 1] = static_cast<std::uint32_t>(out.opaque.quads.size());
  }
  return out;
}

}  // namespace runstone
