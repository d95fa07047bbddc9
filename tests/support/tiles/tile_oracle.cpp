#include "tests/support/tiles/tile_oracle.hpp"

#include <optional>
#include <vector>

#include "common/runs/run_builder.hpp"

namespace runstone::test {
namespace {

constexpr int kSteps[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};

Visibility kind_of(const MaterialTable& materials, Material id) {
  if (id == kEmpty) return Visibility::empty;
  return materials.knows(id) ? materials[id].visibility : Visibility::opaque;
}

bool is_drawn(const MaterialTable& materials, Material id, Material beyond) {
  return kind_of(materials, id) != Visibility::empty && id != beyond &&
         kind_of(materials, beyond) != Visibility::opaque;
}

}  // namespace

DenseChunk expected_tile(const Children& children, unsigned edge, const MaterialTable& materials) {
  const int side = static_cast<int>(edge);
  std::vector<DenseChunk> dense;
  for (const RunChunk* child : children)
    dense.push_back(child == nullptr ? DenseChunk(Extent::cube(edge)) : DenseChunk::of(*child));
  const auto at = [&](int x, int y, int z) -> std::optional<Material> {
    if (x < 0 || y < 0 || z < 0 || x >= 2 * side || y >= 2 * side || z >= 2 * side)
      return std::nullopt;
    const int child = x / side + 2 * (y / side) + 4 * (z / side);
    return dense[static_cast<std::size_t>(child)].at(x % side, y % side, z % side);
  };
  DenseChunk out(Extent::cube(edge));
  for (int i = 0; i < side * side * side; ++i) {
    const int x = i % side, y = i / side % side, z = i / side / side;
    int most = -1;
    // In the order of the rule, so that only a more exposed voxel replaces one.
    for (const int dy : {1, 0}) {
      for (const int dx : {0, 1}) {
        for (const int dz : {0, 1}) {
          const int vx = 2 * x + dx, vy = 2 * y + dy, vz = 2 * z + dz;
          const Material here = *at(vx, vy, vz);
          int exposure = 0;
          for (const auto& step : kSteps) {
            const auto beyond = at(vx + step[0], vy + step[1], vz + step[2]);
            if (beyond && is_drawn(materials, here, *beyond)) ++exposure;
          }
          if (exposure <= most) continue;
          most = exposure;
          out.set(x, y, z, here);
        }
      }
    }
  }
  return out;
}

DenseChunk expected_veil(const DenseChunk& tile, AxisOrder order, const MaterialTable& materials) {
  DenseChunk out = tile;
  for (std::uint32_t i = 1; i < tile.extent().volume(); ++i) {
    const VoxelPos p = dense_pos(tile.extent(), order, i);
    const auto opaque_at = [&](int x, int y, int z) {
      return tile.inside(x, y, z) && kind_of(materials, tile.at(x, y, z)) == Visibility::opaque;
    };
    bool is_enclosed = opaque_at(p.x, p.y, p.z);
    for (const auto& step : kSteps)
      is_enclosed = is_enclosed && opaque_at(p.x + step[0], p.y + step[1], p.z + step[2]);
    if (!is_enclosed) continue;
    const VoxelPos before = dense_pos(tile.extent(), order, i - 1);
    out.set(p.x, p.y, p.z, out.at(before.x, before.y, before.z));
  }
  return out;
}

Children ChildChunks::pointers() const {
  Children out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = &chunks[i];
  return out;
}

ChildChunks children_of(unsigned edge, AxisOrder order,
                        const std::function<Material(int x, int y, int z)>& material) {
  const Extent extent = Extent::cube(edge);
  const int side = static_cast<int>(edge);
  ChildChunks out;
  for (int child = 0; child < 8; ++child) {
    RunBuilder builder(extent, order);
    for (std::uint32_t i = 0; i < extent.volume(); ++i) {
      const LocalPos p = pos_of(i, extent, order);
      builder.append(1, material(p.x + side * (child & 1), p.y + side * (child >> 1 & 1),
                                 p.z + side * (child >> 2)));
    }
    out.chunks[static_cast<std::size_t>(child)] = builder.finish();
  }
  return out;
}

}  // namespace runstone::test
