#include "tests/support/mesh/triangle_oracle.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <sstream>
#include <tuple>
#include <utility>

namespace runstone::test {
namespace {

using Point = std::array<int, 3>;  // by axis

/// A plane in which triangles can cover each other.
struct Sheet {
  int direction = 0, plane = 0;
  Material material = kEmpty;
  friend auto operator<=>(const Sheet&, const Sheet&) = default;
};

std::string text_of(const Sheet& sheet) {
  std::ostringstream out;
  out << "direction " << "-+"[sheet.direction % 2] << "xyz"[sheet.direction / 2] << ", plane "
      << sheet.plane << ", material " << sheet.material;
  return out.str();
}

/// A piece of an edge between neighbouring lattice points of its line, the same in both directions.
struct Piece {
  Sheet sheet;
  std::array<int, 2> at{}, step{};  // u, v
  int times = 0;                    // occurrences along step, minus those against it
  auto place() const { return std::tie(sheet, at, step); }
};

void add_edge(const Sheet& sheet, std::array<int, 2> from, std::array<int, 2> to, int times,
              std::vector<Piece>& pieces) {
  if (to < from) {
    std::swap(from, to);
    times = -times;
  }
  const int count = std::gcd(to[0] - from[0], to[1] - from[1]);
  const std::array<int, 2> step = {(to[0] - from[0]) / count, (to[1] - from[1]) / count};
  for (int i = 0; i < count; ++i) {
    pieces.push_back({sheet, {from[0] + i * step[0], from[1] + i * step[1]}, step, times});
  }
}

/// Subtracts the four sides of a unit face, wound outwards, `times` times.
void add_face(const UnitFace& face, int times, std::vector<Piece>& pieces) {
  const int direction = static_cast<int>(face.direction);
  const auto axis = static_cast<std::size_t>(direction / 2);
  const bool positive = direction % 2 == 1;
  const Point low = {face.x, face.y, face.z};
  const Sheet sheet{direction, low[axis] + (positive ? 1 : 0), face.material};
  const int u = low[(axis + 1) % 3];
  const int v = low[(axis + 2) % 3];
  std::array<std::array<int, 2>, 5> ring = {
      {{u, v}, {u + 1, v}, {u + 1, v + 1}, {u, v + 1}, {u, v}}};
  if (!positive) std::reverse(ring.begin(), ring.end());
  for (std::size_t i = 0; i < 4; ++i) add_edge(sheet, ring[i], ring[i + 1], times, pieces);
}

std::string fault_of_pieces(std::vector<Piece>& pieces) {
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& a, const Piece& b) { return a.place() < b.place(); });
  for (std::size_t i = 0; i < pieces.size();) {
    const Piece& piece = pieces[i];
    int times = 0;
    for (; i < pieces.size() && pieces[i].place() == piece.place(); ++i) times += pieces[i].times;
    if (times == 0) continue;
    std::ostringstream out;
    out << text_of(piece.sheet) << ": at u v " << piece.at[0] << ' ' << piece.at[1] << " towards "
        << piece.at[0] + piece.step[0] << ' ' << piece.at[1] + piece.step[1]
        << " what is covered ends where no face does, or goes on where one ends";
    return out.str();
  }
  return {};
}

Point point_of(const reference::MeshVertex& vertex) { return {vertex.x, vertex.y, vertex.z}; }

}  // namespace

std::optional<std::string> triangles_difference(const reference::TriangleMesh& mesh, Extent extent,
                                                const MaterialTable& materials,
                                                const std::vector<UnitFace>& expected) {
  const Point sides = {extent.x, extent.y, extent.z};
  std::vector<std::optional<Sheet>> used(mesh.vertices.size());
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const reference::MeshTriangle& triangle = mesh.triangles[i];
    const auto wrong = [&](const std::string& why) {
      return "triangle " + std::to_string(i) + ' ' + why;
    };
    const int direction = static_cast<int>(triangle.direction);
    if (direction >= static_cast<int>(kDirectionCount)) return wrong("looks in no direction");
    const auto axis = static_cast<std::size_t>(direction / 2);
    const Material material = triangle.material;
    if (material == kEmpty ||
        (material < materials.size() && materials[material].visibility == Visibility::empty)) {
      return wrong("is of an empty material");
    }
    std::array<Point, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      if (triangle.vertices[c] >= mesh.vertices.size())
        return wrong("has a vertex that does not exist");
      corners[c] = point_of(mesh.vertices[triangle.vertices[c]]);
      for (std::size_t a = 0; a < 3; ++a) {
        if (corners[c][a] > sides[a]) return wrong("leaves the extent");
      }
      if (corners[c][axis] != corners[0][axis]) return wrong("lies across planes");
    }
    const Sheet sheet{direction, corners[0][axis], material};
    for (const std::uint32_t vertex : triangle.vertices) {
      if (used[vertex].value_or(sheet) != sheet) return wrong("shares a vertex with another sheet");
      used[vertex] = sheet;
    }
    std::array<std::array<int, 2>, 3> flat;  // u, v
    for (std::size_t c = 0; c < 3; ++c)
      flat[c] = {corners[c][(axis + 1) % 3], corners[c][(axis + 2) % 3]};
    const int area = (flat[1][0] - flat[0][0]) * (flat[2][1] - flat[0][1]) -
                     (flat[1][1] - flat[0][1]) * (flat[2][0] - flat[0][0]);
    if (area == 0) return wrong("has no area");
    if ((area > 0) != (direction % 2 == 1)) return wrong("winds the wrong way");
    for (std::size_t c = 0; c < 3; ++c) add_edge(sheet, flat[c], flat[(c + 1) % 3], 1, pieces);
  }
  const auto idle = std::find(used.begin(), used.end(), std::nullopt);
  if (idle != used.end()) return "vertex " + std::to_string(idle - used.begin()) + " is not used";
  for (const UnitFace& face : expected) add_face(face, -1, pieces);
  std::string fault = fault_of_pieces(pieces);
  if (!fault.empty()) return fault;
  return std::nullopt;
}

std::optional<std::string> surface_difference(const reference::Surface& surface, Extent extent,
                                              const MaterialTable& materials,
                                              const std::vector<UnitFace>& expected) {
  const reference::TriangleMesh& triangles = surface.triangles;
  if (triangles.vertices.empty() && triangles.triangles.empty()) {
    return quads_difference(surface.quads, extent, materials, expected);
  }
  if (!surface.quads.empty()) return "there are quads and triangles";
  return triangles_difference(triangles, extent, materials, expected);
}

}  // namespace runstone::test
