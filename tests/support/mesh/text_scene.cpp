#include "tests/support/mesh/text_scene.hpp"

#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

using namespace reference;

namespace {

Material material_of(char cell) { return cell == '.' ? kEmpty : static_cast<Material>(cell - '0'); }

}  // namespace

FacePlane plane_of(const std::vector<std::string>& rows) {
  FacePlane plane;
  plane.width = static_cast<std::uint32_t>(rows.front().size());
  plane.height = static_cast<std::uint32_t>(rows.size());
  for (const std::string& row : rows) {
    for (const char cell : row) plane.faces.push_back(material_of(cell));
  }
  return plane;
}

MeshScene scene_of(const std::vector<std::string>& rows) {
  MeshScene scene{uniform_chunk(Extent::cube(8), kEmpty), {}};
  RunChunk& chunk = scene.chunk;
  for (std::size_t x = 0; x < rows.size(); ++x) {
    for (std::size_t z = 0; z < rows[x].size(); ++z) {
      const LocalPos at{static_cast<std::uint8_t>(x + 1), 4, static_cast<std::uint8_t>(z + 1)};
      fill(chunk, index_of(at, chunk.extent, chunk.order), 1, material_of(rows[x][z]));
    }
  }
  return scene;
}

std::vector<PlaneRectangle> upper_side(std::span<const Quad> quads) {
  std::vector<PlaneRectangle> out;
  for (const Quad quad : quads) {
    const QuadFields q = unpack(quad);
    if (q.direction != Direction::pos_y) continue;
    out.push_back({q.z - 1u, q.x - 1u, q.width, q.height, q.material});
  }
  return out;
}

}  // namespace runstone::test
