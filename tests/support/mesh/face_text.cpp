#include "tests/support/mesh/face_text.hpp"

#include <algorithm>

#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {

reference::FacePlane face_plane(const std::vector<std::string>& rows) {
  reference::FacePlane out;
  out.width = static_cast<std::uint32_t>(rows.front().size());
  out.height = static_cast<std::uint32_t>(rows.size());
  for (const std::string& row : rows) {
    for (const char face : row)
      out.faces.push_back(face == '#' ? kStone : face == '+' ? kDirt : kEmpty);
  }
  return out;
}

std::vector<std::string> random_face_text(SplitMix64& rng, unsigned side_max) {
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
