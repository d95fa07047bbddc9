#include "tests/support/veil/veil_oracle.hpp"

#include <vector>

namespace runstone::test {

DenseScene DenseScene::of(const RunChunk& chunk,
                          const std::array<const RunChunk*, kDirectionCount>& neighbours) {
  DenseScene out{DenseChunk::of(chunk), {}};
  for (std::size_t d = 0; d < neighbours.size(); ++d)
    if (neighbours[d] != nullptr) out.neighbours[d] = DenseChunk::of(*neighbours[d]);
  return out;
}

bool oracle_encloses(const DenseScene& scene, VoxelPos at, const VeilOracleRules& rules,
                     VeilFault fault) {
  const auto covered = [&](int dx, int dy, int dz) {
    const int x = at.x + dx, y = at.y + dy, z = at.z + dz;
    if (scene.chunk.inside(x, y, z)) return rules.covers(scene.chunk.at(x, y, z));
    if (fault == VeilFault::forgets_neighbours) return true;
    // Direction lists -x, +x, -y, +y, -z, +z.
    const std::size_t d = dx < 0 ? 0 : dx > 0 ? 1 : dy < 0 ? 2 : dy > 0 ? 3 : dz < 0 ? 4 : 5;
    const auto& beyond = scene.neighbours[d];
    if (!beyond) return rules.missing_covers;
    const auto wrap = [](int v, int own, int theirs) {
      return v < 0 ? theirs - 1 : v >= own ? 0 : v;
    };
    return rules.covers(beyond->at(wrap(x, scene.chunk.side_x(), beyond->side_x()),
                                   wrap(y, scene.chunk.side_y(), beyond->side_y()),
                                   wrap(z, scene.chunk.side_z(), beyond->side_z())));
  };
  if (!covered(0, 0, 0)) return false;
  const bool beside =
      covered(-1, 0, 0) && covered(1, 0, 0) && covered(0, 0, -1) && covered(0, 0, 1);
  if (fault == VeilFault::hides_walls) return beside;
  return beside && covered(0, -1, 0) && covered(0, 1, 0);
}

DenseChunk oracle_veil(const DenseScene& scene, AxisOrder order, const VeilOracleRules& rules,
                       VeilFault fault) {
  const std::uint32_t volume = scene.chunk.extent().volume();
  const auto pos = [&](std::uint32_t i) { return dense_pos(scene.chunk.extent(), order, i); };
  const auto at = [&](std::uint32_t i) {
    const VoxelPos p = pos(i);
    return scene.chunk.at(p.x, p.y, p.z);
  };
  std::vector<bool> enclosed(volume);
  for (std::uint32_t i = 0; i < volume; ++i)
    enclosed[i] = oracle_encloses(scene, pos(i), rules, fault);
  // The voxel that keeps its material before and behind each voxel; `volume` if there is none.
  std::vector<std::uint32_t> before(volume), behind(volume);
  for (std::uint32_t i = 0, last = volume; i < volume; ++i) {
    if (!enclosed[i]) last = i;
    before[i] = last;
  }
  for (std::uint32_t i = volume, next = volume; i-- > 0;) {
    if (!enclosed[i]) next = i;
    behind[i] = next;
  }
  DenseChunk out = scene.chunk;
  for (std::uint32_t i = 0; i < volume; ++i) {
    if (!enclosed[i]) continue;
    Material shown = rules.filler;
    if (before[i] != volume && rules.covers(at(before[i]))) {
      shown = at(before[i]);
    } else if (behind[i] != volume && rules.covers(at(behind[i]))) {
      shown = at(behind[i]);
    }
    const VoxelPos p = pos(i);
    out.set(p.x, p.y, p.z, shown);
  }
  return out;
}

}  // namespace runstone::test
