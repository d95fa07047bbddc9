#include "tests/support/face_picture.hpp"

#include <algorithm>

#include "tests/support/mesh_scene.hpp"

namespace runstone::test {

reference::FaceLayer face_layer(const std::vector<std::string>& rows) {
  // The faces +z of layer 0: nothing lies above them.
  const auto side = [](std::size_t faces) {
    return static_cast<std::uint8_t>(std::max<std::size_t>(faces, 8));
  };
  const Extent extent{side(rows.front().size()), side(rows.size()), 8};
  reference::DenseGrid grid;
  grid.reset(extent, AxisOrder::xyz);
  for (std::ptrdiff_t z = -1; z <= extent.z; ++z) {
    for (std::ptrdiff_t y = -1; y <= extent.y; ++y) std::fill_n(grid.line(y, z) - 1, extent.x + 2, kEmpty);
  }
  for (std::size_t v = 0; v < rows.size(); ++v) {
    for (std::size_t u = 0; u < rows[v].size(); ++u) {
      const char face = rows[v][u];
      grid.line(static_cast<std::ptrdiff_t>(v), 0)[u] = face == '#' ? kStone : face == '+' ? kDirt : kEmpty;
    }
  }
  reference::FaceLayer out;
  out.read(grid, mesh_visibility(), Direction::pos_z, 0);
  return out;
}

std::vector<std::string> random_picture(SplitMix64& rng, unsigned side_max) {
  const std::size_t width = 1 + rng.below(side_max);
  const std::size_t height = 1 + rng.below(side_max);
  std::vector<std::string> rows(height, std::string(width, '.'));
  const char faces[] = {'#', '.', '#', rng.below(2) == 0 ? '+' : '#'};
  const std::uint32_t form = rng.below(3);
  if (form != 0) {
    for (std::uint32_t box = rng.below(12) + 1; box > 0; --box) {
      const char face = faces[rng.below(4)];
      const std::size_t u = rng.below(static_cast<std::uint32_t>(width)),
                        v = rng.below(static_cast<std::uint32_t>(height));
      const std::size_t u_end = u + 1 + rng.below(static_cast<std::uint32_t>(width - u));
      const std::size_t v_end = v + 1 + rng.below(static_cast<std::uint32_t>(height - v));
      for (std::size_t row = v; row < v_end; ++row)
        std::fill(rows[row].begin() + static_cast<std::ptrdiff_t>(u),
                  rows[row].begin() + static_cast<std::ptrdiff_t>(u_end), face);
    }
  }
  if (form != 1) {
    const std::uint32_t density = rng.below(16);
    for (std::string& row : rows) {
      for (char& face : row) {
        if (rng.below(16) < density) face = faces[rng.below(4)];
      }
    }
  }
  return rows;
}

}  // namespace runstone::test
