#include "tests/support/mesh/face_oracle.hpp"

#include <algorithm>
#include <map>
#include <ostream>
#include <sstream>
#include <utility>

#include "common/mesh/quad_corners.hpp"

namespace runstone::test {
namespace {

// Sorts faces, of which there may be millions. Each is packed into a word in the order of its
// fields, and the words are sorted byte by byte from the lowest. Coordinates reach 254 at most,
// whatever the bits of a quad are.
void sort_faces(std::vector<UnitFace>& faces) {
  if (std::is_sorted(faces.begin(), faces.end())) return;
  std::vector<std::uint64_t> keys, sorted(faces.size());
  keys.reserve(faces.size());
  for (const UnitFace& face : faces) {
    std::uint64_t key = 0;
    for (const int at : {face.x, face.y, face.z}) key = key << 8 | static_cast<std::uint64_t>(at);
    keys.push_back((key << 8 | static_cast<std::uint64_t>(face.direction)) << 16 | face.material);
  }
  const auto byte = [](std::uint64_t key, unsigned shift) {
    return static_cast<int>(key >> shift & 255);
  };
  for (unsigned shift = 0; shift < 48; shift += 8) {
    std::array<std::size_t, 257> first{};  // of each value of the byte
    for (const std::uint64_t key : keys) ++first[static_cast<std::size_t>(byte(key, shift)) + 1];
    for (std::size_t value = 1; value < first.size(); ++value) first[value] += first[value - 1];
    for (const std::uint64_t key : keys)
      sorted[first[static_cast<std::size_t>(byte(key, shift))]++] = key;
    keys.swap(sorted);
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::uint64_t key = keys[i];
    faces[i] = {byte(key, 40), byte(key, 32), byte(key, 24), static_cast<Direction>(byte(key, 16)),
                static_cast<Material>(key & 65535)};
  }
}

struct Step {
  Direction direction;
  int dx, dy, dz;
};
constexpr std::array<Step, 6> kSteps = {{{Direction::neg_x, -1, 0, 0},
                                         {Direction::pos_x, 1, 0, 0},
                                         {Direction::neg_y, 0, -1, 0},
                                         {Direction::pos_y, 0, 1, 0},
                                         {Direction::neg_z, 0, 0, -1},
                                         {Direction::pos_z, 0, 0, 1}}};

const char* name_of(Direction direction) {
  constexpr std::array<const char*, 6> kNames = {"-x", "+x", "-y", "+y", "-z", "+z"};
  return kNames.at(static_cast<std::size_t>(direction));
}

// Returns a material's visibility. Ids beyond the table count as opaque.
Visibility visibility_of(const MaterialTable& materials, Material id) {
  if (id == 0) return Visibility::empty;
  return id < materials.size() ? materials[id].visibility : Visibility::opaque;
}

// Returns the material next to a voxel, from the neighbour where the step leaves the chunk.
Material material_beside(const DenseChunk& chunk, const DenseNeighbours& neighbours, int x, int y,
                         int z, const Step& step) {
  x += step.dx;
  y += step.dy;
  z += step.dz;
  if (chunk.inside(x, y, z)) return chunk.at(x, y, z);
  const DenseChunk* other = neighbours.at(static_cast<std::size_t>(step.direction));
  if (other == nullptr) return 0;
  if (step.dx < 0) x = other->side_x() - 1;
  if (step.dx > 0) x = 0;
  if (step.dy < 0) y = other->side_y() - 1;
  if (step.dy > 0) y = 0;
  if (step.dz < 0) z = other->side_z() - 1;
  if (step.dz > 0) z = 0;
  return other->at(x, y, z);
}

// A quad, read from its documented bits (common/mesh/quad.hpp) by a second implementation.
struct Rectangle {
  int x, y, z, width, height, direction;
  Material material;
  std::uint64_t reserved;
};

Rectangle rectangle_of(Quad quad) {
  std::uint64_t rest = quad.bits;
  const auto take = [&rest](unsigned bits) {
    const std::uint64_t value = rest % (1ULL << bits);
    rest >>= bits;
    return static_cast<int>(value);
  };
  Rectangle r{};
  r.x = take(7);
  r.y = take(7);
  r.z = take(7);
  r.width = take(7) + 1;
  r.height = take(7) + 1;
  r.direction = take(3);
  r.material = static_cast<Material>(take(16));
  r.reserved = rest;
  return r;
}

// Returns width and height of a rectangle as sizes along x, y and z.
std::array<int, 3> size_of(const Rectangle& r) {
  switch (r.direction / 2) {
    case 0:
      return {1, r.width, r.height};
    case 1:
      return {r.height, 1, r.width};
    default:
      return {r.width, r.height, 1};
  }
}

template <class F>
void for_each_face(const Rectangle& r, F&& visit) {
  const auto size = size_of(r);
  for (int z = r.z; z < r.z + size[2]; ++z) {
    for (int y = r.y; y < r.y + size[1]; ++y) {
      for (int x = r.x; x < r.x + size[0]; ++x) {
        visit(UnitFace{x, y, z, static_cast<Direction>(r.direction), r.material});
      }
    }
  }
}

// Returns true if the corners lie on the face's plane, span it, and wind counter-clockwise seen
// from the side to which the direction points.
bool winds_outwards(Quad quad, const Rectangle& r) {
  const std::array<Corner, 4> c = quad_corners(quad);
  const auto axis = static_cast<std::size_t>(r.direction / 2);
  const auto edge = [&c](std::size_t from, std::size_t to) {
    return Corner{c[to][0] - c[from][0], c[to][1] - c[from][1], c[to][2] - c[from][2]};
  };
  const std::array<int, 3> low = {r.x, r.y, r.z};
  for (const Corner& corner : c) {
    if (corner[axis] != low[axis] + r.direction % 2) return false;
  }
  const int sign = r.direction % 2 == 1 ? 1 : -1;
  for (std::size_t i = 0; i < 4;
       ++i) {  // each corner turns left, by the area of the whole rectangle
    const Corner a = edge(i, (i + 1) % 4);
    const Corner b = edge((i + 1) % 4, (i + 2) % 4);
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    if (a[u] * b[v] - a[v] * b[u] != sign * r.width * r.height) return false;
  }
  return true;
}

std::string fault_of_rectangle(Quad quad, const Rectangle& r, Extent extent,
                               Visibility visibility) {
  if (r.reserved != 0) return "reserved bits are set";
  if (r.direction >= static_cast<int>(kDirectionCount)) return "looks in no direction";
  const std::array<int, 3> low = {r.x, r.y, r.z};
  const std::array<int, 3> sides = {extent.x, extent.y, extent.z};
  const auto size = size_of(r);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (low[axis] + size[axis] > sides[axis]) return "leaves the extent";
  }
  if (visibility == Visibility::empty) return "is of an empty material";
  if (!winds_outwards(quad, r)) return "winds the wrong way";
  return {};
}

std::string fault_of_place(const Rectangle& r, int direction, int layer, Visibility visibility,
                           bool transparent) {
  if (r.direction != direction) return "grouped under another direction";
  const std::array<int, 3> low = {r.x, r.y, r.z};
  if (low[static_cast<std::size_t>(direction / 2)] != layer) return "grouped under another layer";
  if (visibility != Visibility::empty && (visibility == Visibility::transparent) != transparent) {
    return "stands in the wrong pass";
  }
  return {};
}

std::string describe(const Rectangle& r) {
  std::ostringstream out;
  out << "quad at " << r.x << ' ' << r.y << ' ' << r.z << ", " << r.width << " x " << r.height
      << ", direction " << r.direction << ", material " << r.material;
  return out.str();
}

std::optional<std::string> fault_of_pass(const QuadLayers& pass, bool transparent, Extent extent,
                                         const MaterialTable& materials,
                                         std::vector<UnitFace>& covered) {
  const char* const name = transparent ? "transparent pass: " : "opaque pass: ";
  if (pass.first.front() != 0 || pass.first.back() != pass.quads.size()) {
    return std::string(name) + "the layer index does not span the quads";
  }
  if (!std::is_sorted(pass.first.begin(), pass.first.end())) {
    return std::string(name) + "the layer index descends";
  }
  for (int direction = 0; direction < 6; ++direction) {
    for (int layer = 0; layer < static_cast<int>(kSideMax); ++layer) {
      for (const Quad quad :
           pass.layer(static_cast<Direction>(direction), static_cast<unsigned>(layer))) {
        const Rectangle r = rectangle_of(quad);
        const Visibility visibility = visibility_of(materials, r.material);
        std::string fault = fault_of_rectangle(quad, r, extent, visibility);
        if (fault.empty()) fault = fault_of_place(r, direction, layer, visibility, transparent);
        if (!fault.empty()) return name + describe(r) + ' ' + fault;
        for_each_face(r, [&](const UnitFace& face) { covered.push_back(face); });
      }
    }
  }
  return std::nullopt;
}

std::string text_of(const UnitFace& face) {
  std::ostringstream out;
  out << face;
  return out.str();
}

// Sorts the faces. Names a face that occurs twice, whatever its material.
std::optional<std::string> sorted_fault(std::vector<UnitFace>& covered) {
  sort_faces(covered);
  const auto same_place = [](const UnitFace& a, const UnitFace& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.direction == b.direction;
  };
  const auto twice = std::adjacent_find(covered.begin(), covered.end(), same_place);
  if (twice != covered.end()) return text_of(*twice) + " is covered twice";
  return std::nullopt;
}

// Requires sorted lists.
std::optional<std::string> first_odd_face(const std::vector<UnitFace>& found,
                                          const std::vector<UnitFace>& expected) {
  const auto [is, should] =
      std::mismatch(found.begin(), found.end(), expected.begin(), expected.end());
  if (is == found.end() && should == expected.end()) return std::nullopt;
  if (should == expected.end() || (is != found.end() && *is < *should))
    return text_of(*is) + " is too many";
  return text_of(*should) + " is missing";
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const UnitFace& face) {
  return out << "face " << name_of(face.direction) << " of voxel " << face.x << ' ' << face.y << ' '
             << face.z << " in material " << face.material;
}

namespace {

/// Calls visit(x, y, z, material) for each drawn voxel, in the order of faces.
template <class F>
void each_drawn_voxel(const DenseChunk& chunk, const MaterialTable& materials, F&& visit) {
  for (int x = 0; x < chunk.side_x(); ++x) {
    for (int y = 0; y < chunk.side_y(); ++y) {
      for (int z = 0; z < chunk.side_z(); ++z) {
        const Material here = chunk.at(x, y, z);
        if (visibility_of(materials, here) != Visibility::empty) visit(x, y, z, here);
      }
    }
  }
}

}  // namespace

std::vector<UnitFace> exposed_faces(const DenseChunk& chunk, const DenseNeighbours& neighbours,
                                    const MaterialTable& materials) {
  std::vector<UnitFace> faces;
  each_drawn_voxel(chunk, materials, [&](int x, int y, int z, Material here) {
    for (const Step& step : kSteps) {
      const Material there = material_beside(chunk, neighbours, x, y, z, step);
      if (there == here || visibility_of(materials, there) == Visibility::opaque) continue;
      faces.push_back({x, y, z, step.direction, here});
    }
  });
  sort_faces(faces);
  return faces;
}

std::vector<UnitFace> all_faces(const DenseChunk& chunk, const MaterialTable& materials) {
  std::vector<UnitFace> faces;
  each_drawn_voxel(chunk, materials, [&](int x, int y, int z, Material here) {
    for (const Step& step : kSteps) faces.push_back({x, y, z, step.direction, here});
  });
  sort_faces(faces);
  return faces;
}

std::vector<UnitFace> tail_culled_faces(const DenseChunk& chunk, const MaterialTable& materials) {
  const int line = chunk.side_z();
  const int layer = line * chunk.side_y();
  const auto at_index = [&](int i) {
    return chunk.at(i / layer, i / line % chunk.side_y(), i % line);
  };
  const auto same_from = [&](int first, int last, Material material) {  // within the chunk
    if (first < 0) return false;
    for (int i = last; i >= first; --i) {
      if (at_index(i) != material) return false;
    }
    return true;
  };
  std::vector<UnitFace> faces;
  for (int x = 0; x < chunk.side_x(); ++x) {
    for (int y = 0; y < chunk.side_y(); ++y) {
      for (int z = 0; z < line;) {
        const Material here = chunk.at(x, y, z);
        int end = z + 1;
        while (end < line && chunk.at(x, y, end) == here) ++end;
        const int piece = x * layer + y * line + z;
        const bool hides_y = y > 0 && same_from(piece - line, piece, here);
        const bool hides_x = same_from(piece - layer, piece, here);
        const bool drawn = visibility_of(materials, here) != Visibility::empty;
        for (int at = z; drawn && at < end; ++at) {
          faces.push_back({x, y, at, Direction::pos_x, here});
          faces.push_back({x, y, at, Direction::pos_y, here});
          if (!hides_x) faces.push_back({x, y, at, Direction::neg_x, here});
          if (!hides_y) faces.push_back({x, y, at, Direction::neg_y, here});
          if (at == z) faces.push_back({x, y, at, Direction::neg_z, here});
          if (at + 1 == end) faces.push_back({x, y, at, Direction::pos_z, here});
        }
        z = end;
      }
    }
  }
  sort_faces(faces);
  return faces;
}

std::vector<UnitFace> run_on_faces(const DenseChunk& chunk, const std::vector<UnitFace>& exposed) {
  std::vector<UnitFace> faces = exposed;
  for (UnitFace face : exposed) {  // the faces between it and the next exposed one
    for (;;) {
      (face.direction == Direction::neg_y || face.direction == Direction::pos_y ? face.x
                                                                                : face.y)++;
      if (!chunk.inside(face.x, face.y, face.z) ||
          chunk.at(face.x, face.y, face.z) != face.material)
        break;
      if (std::binary_search(exposed.begin(), exposed.end(), face)) break;
      faces.push_back(face);
    }
  }
  sort_faces(faces);
  return faces;
}

std::vector<UnitFace> unit_faces(const ChunkMesh& mesh) {
  std::vector<UnitFace> faces;
  for (const QuadLayers* pass : {&mesh.opaque, &mesh.transparent}) {
    for (const Quad quad : pass->quads) {
      for_each_face(rectangle_of(quad), [&](const UnitFace& face) { faces.push_back(face); });
    }
  }
  sort_faces(faces);
  return faces;
}

namespace {

/// Does mesh_fault(). If there is no fault, `covered` are the sorted faces of the mesh.
std::optional<std::string> fault_and_faces(const ChunkMesh& mesh, Extent extent,
                                           const MaterialTable& materials,
                                           std::vector<UnitFace>& covered) {
  if (auto fault = fault_of_pass(mesh.opaque, false, extent, materials, covered)) return fault;
  if (auto fault = fault_of_pass(mesh.transparent, true, extent, materials, covered)) return fault;
  return sorted_fault(covered);
}

}  // namespace

std::optional<std::string> mesh_fault(const ChunkMesh& mesh, Extent extent,
                                      const MaterialTable& materials) {
  std::vector<UnitFace> covered;
  return fault_and_faces(mesh, extent, materials, covered);
}

std::optional<std::string> mesh_difference(const ChunkMesh& mesh, Extent extent,
                                           const MaterialTable& materials,
                                           const std::vector<UnitFace>& expected) {
  std::vector<UnitFace> covered;
  if (auto fault = fault_and_faces(mesh, extent, materials, covered)) return fault;
  return first_odd_face(covered, expected);
}

std::optional<std::string> quads_difference(std::span<const Quad> quads, Extent extent,
                                            const MaterialTable& materials,
                                            const std::vector<UnitFace>& expected) {
  std::vector<UnitFace> covered;
  for (const Quad quad : quads) {
    const Rectangle r = rectangle_of(quad);
    const std::string fault =
        fault_of_rectangle(quad, r, extent, visibility_of(materials, r.material));
    if (!fault.empty()) return describe(r) + ' ' + fault;
    for_each_face(r, [&](const UnitFace& face) { covered.push_back(face); });
  }
  if (auto fault = sorted_fault(covered)) return fault;
  return first_odd_face(covered, expected);
}

std::size_t greedy_quad_count(const std::vector<UnitFace>& faces) {
  // cells that are not covered yet, by (v, u)
  using Cells = std::map<std::pair<int, int>, Material>;
  std::map<std::pair<Direction, int>, Cells> planes;
  for (const UnitFace& face : faces) {
    const std::array<int, 3> at = {face.x, face.y, face.z};
    const auto axis = static_cast<std::size_t>(face.direction) / 2;
    planes[{face.direction, at.at(axis)}][{at.at((axis + 2) % 3), at.at((axis + 1) % 3)}] =
        face.material;
  }
  std::size_t quads = 0;
  for (auto& plane : planes) {
    Cells& cells = plane.second;
    while (!cells.empty()) {
      const Material material = cells.begin()->second;
      const int v0 = cells.begin()->first.first;
      const int u0 = cells.begin()->first.second;
      // Returns the number of open cells of this material in the row from u0 on, up to `most`.
      const auto open_width = [&cells, u0, material](int v, int most) {
        int width = 0;
        for (; width < most; ++width) {
          const auto cell = cells.find({v, u0 + width});
          if (cell == cells.end() || cell->second != material) break;
        }
        return width;
      };
      const int width = open_width(v0, kSideMax);
      for (int v = v0; open_width(v, width) == width; ++v) {
        for (int u = u0; u < u0 + width; ++u) cells.erase({v, u});
      }
      ++quads;
    }
  }
  return quads;
}

}  // namespace runstone::test
