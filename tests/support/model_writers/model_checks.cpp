#include "tests/support/model_writers/model_checks.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <utility>

#include "common/formats/file_build.hpp"

namespace runstone::test {

const std::vector<std::string>& model_endings_written() {
  static const std::vector<std::string> kEndings = {".glb", ".gltf", ".obj", ".ply"};
  return kEndings;
}

Bytes model_bytes(const std::string& file, const FileBuild& build, const ModelWriting& writing) {
  Bytes out;
  const auto done = write_file_build(file, build,
                                     [&](ByteView bytes) {
                                       out.insert(out.end(), bytes.begin(), bytes.end());
                                       return true;
                                     },
                                     {.model = writing});
  INFO((done ? "" : done.error()));
  REQUIRE(done.has_value());
  return out;
}

WrittenModel model_of(const std::string& ending, const FileBuild& build,
                      const ModelWriting& writing) {
  const Bytes file = model_bytes("a/castle" + ending, build, writing);
  if (ending == ".glb") return read_written_glb(file);
  if (ending == ".gltf") return read_written_gltf(file);
  if (ending == ".ply") return read_written_ply(file);
  CHECK(companion_file("a/castle.obj") == "a/castle.mtl");
  Bytes mtl;
  REQUIRE(write_companion("a/castle.obj", build, [&](ByteView bytes) {
            mtl.insert(mtl.end(), bytes.begin(), bytes.end());
            return true;
          }).has_value());
  return read_written_obj(file, mtl);
}

namespace {

std::string colour_of(const BuildMaterial& material) {
  std::string out;
  for (const std::uint8_t part : material.row.colour)
    out += (out.empty() ? "" : " ") + std::to_string(part);
  return out;
}

}  // namespace

CellFaces exposed_cell_faces(const FileBuild& build) {
  std::map<Material, const BuildMaterial*> rows;
  for (std::size_t i = 0; i < build.materials.size(); ++i)
    rows[build.build->palette()[i]] = &build.materials[i];
  const auto material_at_cell = [&](VoxelPos cell) -> const BuildMaterial* {
    if (!build.build->box().contains(cell)) return nullptr;
    const auto material = build.build->at(cell);
    if (!material || rows.at(*material)->row.visibility == Visibility::empty) return nullptr;
    return rows.at(*material);
  };
  CellFaces out;
  const VoxelPos sides = build.build->sides();
  for (int z = 0; z < sides.z; ++z) {
    for (int y = 0; y < sides.y; ++y) {
      for (int x = 0; x < sides.x; ++x) {
        const BuildMaterial* here = material_at_cell({x, y, z});
        if (here == nullptr) continue;
        for (int d = 0; d < kDirectionCount; ++d) {
          const ChunkCoord to = neighbour(ChunkCoord{x, y, z}, static_cast<Direction>(d));
          const BuildMaterial* there = material_at_cell({to.x, to.y, to.z});
          if (there == here) continue;
          if (there != nullptr && there->row.visibility == Visibility::opaque) continue;
          out[{x, y, z, d}] = colour_of(*here);
        }
      }
    }
  }
  return out;
}

namespace {

/// Returns twice the area of a triangle whose normal lies along an axis, with the sign of its
/// winding.
double signed_area(const WrittenTriangle& t, std::size_t axis) {
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  return (t.places[1][u] - t.places[0][u]) * (t.places[2][v] - t.places[0][v]) -
         (t.places[1][v] - t.places[0][v]) * (t.places[2][u] - t.places[0][u]);
}

}  // namespace

void check_faces(const CellFaces& expected, const WrittenModel& model, double scale) {
  std::map<CellFace, std::array<int, 4>> hits;
  constexpr double kSamples[4][2] = {
      {0.0371, 0.0149}, {0.9713, 0.0457}, {0.9391, 0.9837}, {0.0219, 0.9533}};
  double area = 0;
  std::string fault;
  for (WrittenTriangle t : model.triangles) {
    for (ModelPlace& place : t.places) {
      for (double& v : place) v = std::round(v / scale * 1024) / 1024;
    }
    std::size_t axis = 0;
    while (axis < 3 && t.normal[axis] == 0) ++axis;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool is_positive_side = t.normal[axis] > 0;
    if (std::abs(t.normal[axis]) != 1 || t.normal[u] != 0 || t.normal[v] != 0) fault = "normal";
    if (t.places[0][axis] != t.places[1][axis] || t.places[0][axis] != t.places[2][axis])
      fault = "a triangle lies in no plane";
    const double twice = signed_area(t, axis);
    if (is_positive_side ? twice <= 0 : twice >= 0) fault = "winding";
    area += std::abs(twice) / 2;
    const auto along = [&](std::size_t a) {
      return std::pair(std::min({t.places[0][a], t.places[1][a], t.places[2][a]}),
                       std::max({t.places[0][a], t.places[1][a], t.places[2][a]}));
    };
    const auto [u_low, u_high] = along(u);
    const auto [v_low, v_high] = along(v);
    for (int i = static_cast<int>(u_low); i < u_high; ++i) {
      for (int j = static_cast<int>(v_low); j < v_high; ++j) {
        for (std::size_t s = 0; s < 4; ++s) {
          bool is_inside = true;
          for (std::size_t k = 0; k < 3; ++k) {
            WrittenTriangle part = t;
            part.places[k][u] = i + kSamples[s][0];
            part.places[k][v] = j + kSamples[s][1];
            is_inside = is_inside && (signed_area(part, axis) > 0) == is_positive_side;
          }
          if (!is_inside) continue;
          std::array<int, 3> cell{};
          cell[axis] = static_cast<int>(t.places[0][axis]) - (is_positive_side ? 1 : 0);
          cell[u] = i;
          cell[v] = j;
          const CellFace face{cell[0], cell[1], cell[2],
                              static_cast<int>(2 * axis) + (is_positive_side ? 1 : 0)};
          const auto found = expected.find(face);
          if (found == expected.end()) {
            fault = "a face that is not exposed";
          } else if (found->second != t.colour) {
            fault = "colour " + t.colour + " instead of " + found->second;
          }
          ++hits[face][s];
        }
      }
    }
  }
  CHECK(fault == "");
  CHECK(hits.size() == expected.size());
  bool is_once = true;
  for (const auto& [face, counts] : hits)
    is_once = is_once && counts == std::array<int, 4>{1, 1, 1, 1};
  CHECK(is_once);
  CHECK(area == Approx(static_cast<double>(expected.size())));
}

namespace {

/// Returns how many directed edges have another number of opposites. `key` names an end of an edge.
template <class Key>
std::size_t open_edges(const WrittenModel& model,
                       const std::function<Key(const WrittenTriangle&, std::size_t)>& key) {
  std::map<std::pair<Key, Key>, int> edges;
  for (const WrittenTriangle& t : model.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Key a = key(t, k), b = key(t, (k + 1) % 3);
      ++edges[{a, b}];
      --edges[{b, a}];
    }
  }
  std::size_t open = 0;
  for (const auto& [edge, balance] : edges) open += balance != 0;
  return open;
}

}  // namespace

std::size_t open_edges_by_place(const WrittenModel& model) {
  return open_edges<ModelPlace>(
      model, [](const WrittenTriangle& t, std::size_t k) { return t.places[k]; });
}

std::size_t open_edges_by_vertex(const WrittenModel& model) {
  return open_edges<std::uint64_t>(
      model, [](const WrittenTriangle& t, std::size_t k) { return t.vertices[k]; });
}

}  // namespace runstone::test
