// The quads of shapes are compared with an oracle that reads every voxel of a chunk and every cell
// beyond a face.
#include "common/mesh/shapes/shape_mesher.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <optional>
#include <tuple>

#include "common/core/hash.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr Material kShapeMaterials = 14;

struct ShapeWorld {
  std::vector<Visibility> visibilities;
  std::vector<Shape> shapes;
  std::vector<std::vector<ShapeFace>> faces;  // of the shapes
};

struct ShapeScene {
  RunChunk chunk;
  std::array<std::optional<RunChunk>, kDirectionCount> neighbours;

  MeshNeighbours pointers() const {
    MeshNeighbours out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = neighbours[i] ? &*neighbours[i] : nullptr;
    return out;
  }
  /// Returns the material at a place, which may lie beyond one side.
  Material at(std::array<int, 3> p) const {
    const auto sides = chunk.extent.sides();
    const RunChunk* of = &chunk;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (p[axis] >= 0 && p[axis] < sides[axis]) continue;
      const auto& beyond = neighbours[axis * 2 + (p[axis] < 0 ? 0 : 1)];
      if (!beyond) return kEmpty;
      of = &*beyond;
      p[axis] = p[axis] < 0 ? of->extent.sides()[axis] - 1 : 0;
    }
    return material_at(*of, {static_cast<std::uint8_t>(p[0]), static_cast<std::uint8_t>(p[1]),
                             static_cast<std::uint8_t>(p[2])});
  }
};

/// Returns a random box, which often reaches the borders of its voxel.
ShapeBox random_box(SplitMix64& rng) {
  ShapeBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t low = rng.below(2) == 0 ? 0 : 4 * rng.below(4);
    box.min[axis] = static_cast<std::uint8_t>(low);
    box.max[axis] =
        static_cast<std::uint8_t>(rng.below(2) == 0 ? 16 : low + 1 + rng.below(16 - low));
  }
  return box;
}

/// Returns cubes and shapes of every visibility. The last shape has more faces in a direction than
/// the mesher reads at a time.
ShapeWorld random_world(SplitMix64& rng) {
  ShapeWorld out;
  for (Material i = 0; i < kShapeMaterials; ++i) {
    constexpr std::array kSome = {Visibility::opaque, Visibility::opaque, Visibility::transparent};
    out.visibilities.push_back(rng.below(16) == 0 ? Visibility::empty : kSome[rng.below(3)]);
    Shape shape;
    if (i > 0 && rng.below(3) != 0) {
      shape.form = rng.below(6) == 0 ? ShapeForm::crossed : ShapeForm::boxes;
      for (std::uint32_t boxes = 1 + rng.below(3); boxes != 0; --boxes)
        shape.boxes.push_back(random_box(rng));
    }
    out.shapes.push_back(std::move(shape));
  }
  Shape grid;
  for (std::uint8_t box = 0; box < 32; ++box) {
    const auto at = static_cast<std::uint8_t>(box % 8 * 2),
               row = static_cast<std::uint8_t>(box / 8 * 4);
    grid.boxes.push_back(
        {{at, 0, row},
         {static_cast<std::uint8_t>(at + 1), 16, static_cast<std::uint8_t>(row + 3)}});
  }
  // A second set of bars across the first leaves many small rectangles above.
  for (std::uint8_t box = 0; box < 16; ++box)
    grid.boxes[box] = {
        {0, box, box},
        {16, static_cast<std::uint8_t>(box + 1), static_cast<std::uint8_t>(box + 1)}};
  out.shapes.back() = std::move(grid);
  out.visibilities.back() = Visibility::opaque;
  for (const Shape& shape : out.shapes) {
    out.faces.emplace_back();
    if (shape.is_cube()) continue;
    const ShapeFaces of(shape);
    out.faces.back().assign(of.faces().begin(), of.faces().end());
  }
  return out;
}

/// Returns a random chunk of the materials below kShapeMaterials.
RunChunk chunk_of_shapes(SplitMix64& rng, Extent extent) {
  const RunChunk any = random_chunk(rng, extent, random_order(rng), kShapeMaterials);
  RunBuilder out(any.extent, any.order);
  for (std::size_t i = 0; i < any.runs.size(); ++i)
    out.append_to(any.runs.end(i), static_cast<Material>(any.runs.material(i) % kShapeMaterials));
  return out.finish();
}

ShapeScene random_shape_scene(SplitMix64& rng) {
  const auto side = [&rng] { return static_cast<std::uint8_t>(kSideMin + rng.below(7)); };
  const Extent extent{side(), side(), side()};
  ShapeScene out{chunk_of_shapes(rng, extent), {}};
  for (std::size_t i = 0; i < out.neighbours.size(); ++i) {
    if (rng.below(4) == 0) continue;
    auto sides = extent.sides();
    sides[i / 2] = side();
    const Extent beside{static_cast<std::uint8_t>(sides[0]), static_cast<std::uint8_t>(sides[1]),
                        static_cast<std::uint8_t>(sides[2])};
    out.neighbours[i] =
        rng.below(4) == 0 ? uniform_chunk(beside, static_cast<Material>(rng.below(kShapeMaterials)))
                          : chunk_of_shapes(rng, beside);
  }
  return out;
}

bool fills_cell(const Shape& shape, std::array<int, 3> cell) {
  if (shape.form == ShapeForm::crossed) return false;
  return std::any_of(shape.boxes.begin(), shape.boxes.end(), [&](const ShapeBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cell[axis] < box.min[axis] || cell[axis] >= box.max[axis]) return false;
    }
    return true;
  });
}

/// Returns true if nothing before the face of a voxel hides it.
bool shows(const ShapeWorld& world, Material own, const ShapeFace& face, Material before) {
  const auto axis = static_cast<std::size_t>(axis_of(face.direction));
  const int border = is_positive(face.direction) ? 16 : 0;
  if (face.depth != border || face.far_depth != border) return true;
  const bool is_opaque = world.visibilities[before] == Visibility::opaque && before != kEmpty;
  const Shape& shape = world.shapes[before];
  if (shape.is_cube()) return !is_opaque;
  if (!is_opaque && before != own) return true;
  for (int u = face.u0; u < face.u1; ++u) {
    for (int v = face.v0; v < face.v1; ++v) {
      std::array<int, 3> cell{};
      cell[axis] = border == 16 ? 0 : 15;
      cell[(axis + 1) % 3] = u;
      cell[(axis + 2) % 3] = v;
      if (!fills_cell(shape, cell)) return true;
    }
  }
  return false;
}

/// A face of a voxel: its place, its material and the number of the face.
using VoxelFace = std::tuple<int, int, int, Material, std::size_t>;
using FaceCounts = std::map<VoxelFace, int>;

FaceCounts expected_in(const ShapeScene& scene, const ShapeWorld& world, Visibility pass) {
  FaceCounts out;
  for (int x = 0; x < scene.chunk.extent.x; ++x) {
    for (int y = 0; y < scene.chunk.extent.y; ++y) {
      for (int z = 0; z < scene.chunk.extent.z; ++z) {
        const Material own = scene.at({x, y, z});
        if (own == kEmpty || world.visibilities[own] != pass || world.shapes[own].is_cube())
          continue;
        const std::vector<ShapeFace>& faces = world.faces[own];
        for (std::size_t i = 0; i < faces.size(); ++i) {
          std::array<int, 3> next = {x, y, z};
          const Direction d = faces[i].direction;
          next[static_cast<std::size_t>(axis_of(d))] += is_positive(d) ? 1 : -1;
          if (shows(world, own, faces[i], scene.at(next))) ++out[{x, y, z, own, i}];
        }
      }
    }
  }
  return out;
}

FaceCounts covered_by(const std::vector<Quad>& quads, const ShapeWorld& world) {
  FaceCounts out;
  for (const Quad quad : quads) {
    const QuadFields q = unpack(quad);
    const std::vector<ShapeFace>& faces = world.faces[q.material];
    if (q.face == 0 || q.face > faces.size()) FAIL("a quad without a face of its material");
    const ShapeFace& face = faces[q.face - 1U];
    if (face.direction != q.direction) FAIL("a quad of another direction than its face");
    const bool joins_u = face.is_flat() && face.u0 == 0 && face.u1 == 16;
    const bool joins_v = face.is_flat() && face.v0 == 0 && face.v1 == 16;
    if ((q.width > 1 && !joins_u) || (q.height > 1 && !joins_v))
      FAIL("a quad of faces that do not join");
    const auto axis = static_cast<std::size_t>(axis_of(q.direction));
    for (int u = 0; u < q.width; ++u) {
      for (int v = 0; v < q.height; ++v) {
        std::array<int, 3> p = {q.x, q.y, q.z};
        p[(axis + 1) % 3] += u;
        p[(axis + 2) % 3] += v;
        ++out[{p[0], p[1], p[2], q.material, q.face - std::size_t{1}}];
      }
    }
  }
  return out;
}

bool ascends_by_direction(const std::vector<Quad>& quads) {
  return std::is_sorted(quads.begin(), quads.end(),
                        [](Quad a, Quad b) { return unpack(a).direction < unpack(b).direction; });
}

TEST_CASE("random shapes mesh to the faces that show, each once", "[mesh][shapes][property]") {
  SplitMix64 rng(Catch::rngSeed() + 49);
  ShapeScratch scratch;  // one for all: contents left by a scene would show in the next
  ShapeQuads quads;
  std::size_t faces = 0, count = 0, transparent = 0;
  for (int scene_number = 0; scene_number < 60; ++scene_number) {
    const ShapeWorld world = random_world(rng);
    const VisibilityTable visibility(world.visibilities);
    const ShapeTable shapes(world.shapes);
    const ShapeScene scene = random_shape_scene(rng);
    CAPTURE(Catch::rngSeed(), scene_number, scene.chunk.order);
    mesh_shapes(scene.chunk, scene.pointers(), visibility, shapes, scratch, quads);
    const FaceCounts opaque = expected_in(scene, world, Visibility::opaque);
    const FaceCounts clear = expected_in(scene, world, Visibility::transparent);
    REQUIRE(covered_by(quads.opaque, world) == opaque);
    REQUIRE(covered_by(quads.transparent, world) == clear);
    REQUIRE(ascends_by_direction(quads.opaque));
    REQUIRE(ascends_by_direction(quads.transparent));
    ShapeQuads again;
    ShapeScratch fresh;
    mesh_shapes(scene.chunk, scene.pointers(), visibility, shapes, fresh, again);
    REQUIRE(again.opaque == quads.opaque);
    REQUIRE(again.transparent == quads.transparent);
    faces += opaque.size() + clear.size();
    count += quads.opaque.size() + quads.transparent.size();
    transparent += quads.transparent.size();
  }
  CHECK(faces > count);
  CHECK(transparent > 0);
}

}  // namespace
}  // namespace runstone::test
