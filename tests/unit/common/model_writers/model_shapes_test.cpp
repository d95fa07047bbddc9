// Models of builds with shapes: slabs, stairs, fences, panes and plants.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "common/formats/file_build.hpp"
#include "common/mesh/shapes/shape_mesher.hpp"
#include "common/model_writers/model_writers.hpp"
#include "common/shapes/shape_kinds.hpp"
#include "tests/support/formats/file_builds.hpp"
#include "tests/support/model_writers/model_checks.hpp"
#include "tests/support/model_writers/written_model.hpp"

namespace runstone::test {
namespace {

BuildMaterial material_of_kind(const std::string& kind, const std::string& states,
                               MaterialColour colour) {
  BuildMaterial out = file_material(kind, states, colour);
  out.row.shape = shape_of_kind(kind, states).value();
  return out;
}

const std::vector<BuildMaterial>& shape_materials() {
  static const std::vector<BuildMaterial> kMaterials = {
      file_material("stone", "", {120, 121, 122, 255}),
      material_of_kind("stairs", "facing=north", {200, 10, 3, 255}),
      material_of_kind("stairs", "facing=east,half=top", {200, 90, 3, 255}),
      material_of_kind("slab", "type=bottom", {9, 90, 3, 255}),
      material_of_kind("fence", "east=true,south=true", {1, 90, 200, 255}),
      material_of_kind("fence", "east=true,west=true", {2, 90, 200, 255}),
      material_of_kind("fence", "west=true,south=true", {3, 90, 200, 255}),
      material_of_kind("fence", "north=true,south=true", {4, 90, 200, 255}),
      material_of_kind("fence", "north=true,east=true", {5, 90, 200, 255}),
      material_of_kind("fence", "north=true,west=true", {6, 90, 200, 255}),
      material_of_kind("pane", "east=true,west=true", {240, 250, 255, 50}),
      material_of_kind("anvil", "facing=east", {60, 60, 70, 255}),
      material_of_kind("plant", "", {10, 200, 10, 255})};
  return kMaterials;
}
constexpr std::uint16_t kStone = 1, kStairs = 2, kTopStairs = 3, kSlab = 4, kPane = 11, kAnvil = 12,
                        kPlant = 13;

bool fills(const Shape& shape, VoxelPos cell) {
  if (shape.is_cube()) return true;
  if (shape.form == ShapeForm::crossed) return false;
  return std::any_of(shape.boxes.begin(), shape.boxes.end(), [&](const ShapeBox& box) {
    return cell.x >= box.min[0] && cell.x < box.max[0] && cell.y >= box.min[1] &&
           cell.y < box.max[1] && cell.z >= box.min[2] && cell.z < box.max[2];
  });
}

/// Returns the build with 16 x 16 x 16 cubes in place of each voxel.
FileBuild in_small_voxels(const FileBuild& build) {
  std::vector<BuildMaterial> cubes = build.materials;
  for (BuildMaterial& material : cubes) material.row.shape = {};
  const VoxelPos sides = build.build->sides();
  return file_build({16 * sides.x, 16 * sides.y, 16 * sides.z}, cubes, [&](VoxelPos at) {
    const auto material = build.build->at({at.x / 16, at.y / 16, at.z / 16});
    const std::uint16_t number = material ? build.build->number_of(*material).value() : 0;
    if (number == 0) return number;
    const bool is_filled =
        fills(build.materials[number - 1U].row.shape, {at.x % 16, at.y % 16, at.z % 16});
    return is_filled ? number : std::uint16_t{0};
  });
}

/// Returns the volume that a closed surface encloses.
double volume_in(const WrittenModel& model) {
  double out = 0;
  for (const WrittenTriangle& t : model.triangles) {
    const auto& [a, b, c] = t.places;
    out += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return out / 6;
}

ModelPlace crossed_product(const WrittenTriangle& t) {
  ModelPlace a, b;
  for (std::size_t i = 0; i < 3; ++i) {
    a[i] = t.places[1][i] - t.places[0][i];
    b[i] = t.places[2][i] - t.places[0][i];
  }
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length_of(const ModelPlace& v) { return std::hypot(v[0], v[1], v[2]); }
double area_of(const WrittenModel& model) {
  double out = 0;
  for (const WrittenTriangle& t : model.triangles) out += length_of(crossed_product(t)) / 2;
  return out;
}

ModelWriting shape_writing(unsigned choice) {
  ModelWriting out;
  out.is_welded = (choice & 1) == 0;
  out.closes_t_junctions = (choice & 2) != 0;
  out.is_quantised = (choice & 4) != 0;
  return out;
}

/// A staircase whose steps touch along edges.
FileBuild staircase() {
  return file_build({1, 4, 4}, shape_materials(),
                    [](VoxelPos at) { return at.y == 3 - at.z ? kStairs : std::uint16_t{0}; });
}

/// A square of fences that are connected.
FileBuild fence_square() {
  constexpr std::uint16_t kRows[3][3] = {{5, 6, 7}, {8, 0, 8}, {9, 6, 10}};
  return file_build({3, 1, 3}, shape_materials(), [&](VoxelPos at) { return kRows[at.z][at.x]; });
}

/// Solid materials in every second voxel, so that none hides a face of another one.
FileBuild shapes_apart(SplitMix64& rng) {
  return file_build({5, 3, 5}, shape_materials(), [&](VoxelPos at) {
    const bool is_place = at.x % 2 == 0 && at.y % 2 == 0 && at.z % 2 == 0;
    return static_cast<std::uint16_t>(is_place ? 1 + rng.below(kAnvil) : 0);
  });
}

/// Shapes and cubes on both sides of the plane between two regions. A corner of the stairs lies
/// within an edge of the cube.
FileBuild shapes_at_regions() {
  return file_build({131, 2, 1}, shape_materials(), [](VoxelPos at) {
    if (at.y == 1) return at.x == 128 ? kStone : std::uint16_t{0};
    if (at.x == 130) return kAnvil;
    if (at.x > 120 && at.x < 124) return kSlab;
    return at.x > 124 && at.x < 128 ? kStairs : std::uint16_t{0};
  });
}

/// All materials, beside each other by chance.
FileBuild shapes_by_chance(SplitMix64& rng, VoxelPos sides) {
  return file_build(sides, shape_materials(), [&](VoxelPos) {
    return static_cast<std::uint16_t>(rng.below(3) == 0 ? 1 + rng.below(kPlant) : 0);
  });
}

/// Returns the smallest cube of grains that has too many faces of shapes for one region.
FileBuild too_many_grains() {
  BuildMaterial grains = file_material("grains", "", {9, 9, 9, 255});
  for (std::uint8_t i = 0; i < 32; ++i) {
    const auto x = static_cast<std::uint8_t>(4 * (i % 4)),
               z = static_cast<std::uint8_t>(2 * (i / 4));
    grains.row.shape.boxes.push_back(
        {{x, 1, z}, {static_cast<std::uint8_t>(x + 1), 2, static_cast<std::uint8_t>(z + 1)}});
  }
  static_assert(23 * 23 * 23 * 32 * 6 > kShapeQuadsMax);
  return file_build({23, 23, 23}, {grains}, [](VoxelPos) { return std::uint16_t{1}; });
}

void check_too_many(const FileBuild& build, const std::string& ending) {
  const auto done = write_file_build("x" + ending, build, [](ByteView) { return true; });
  REQUIRE_FALSE(done.has_value());
  CHECK(done.error() == "x" + ending +
                            ": model: 128 x 128 x 128 voxels have too many faces of shapes; use "
                            "simpler shapes");
}

}  // namespace

TEST_CASE("shapes have the faces and the volume of the same boxes as small voxels",
          "[model_writers][shapes]") {
  SplitMix64 rng(4821);
  const FileBuild builds[] = {staircase(), fence_square(), shapes_apart(rng), shapes_at_regions()};
  const std::size_t each = GENERATE(0U, 1U, 2U, 3U);
  CAPTURE(each);
  const FileBuild small = in_small_voxels(builds[each]);
  const CellFaces expected = exposed_cell_faces(small);
  const double volume = static_cast<double>(small.build->solid()) / 4096;
  if (each == 0) CHECK(volume == 3);  // four steps of three quarters
  std::size_t open_before = 0;
  for (const std::string& ending : model_endings_written()) {
    for (const unsigned choice : {0U, 1U, 2U, 3U, 4U, 7U}) {
      if ((choice & 4) != 0 && ending[1] != 'g') continue;
      CAPTURE(ending, choice);
      const WrittenModel model = model_of(ending, builds[each], shape_writing(choice));
      check_faces(expected, model, 1.0 / 16);
      CHECK(volume_in(model) == Approx(volume));
      if ((choice & 2) == 0) {
        open_before += open_edges_by_place(model);
        continue;
      }
      CHECK(open_edges_by_place(model) == 0);
      if (ending == ".obj" && choice == 2) CHECK(open_edges_by_vertex(model) == 0);
    }
  }
  CHECK(open_before > 0);  // otherwise the test of closed edges shows nothing
}

TEST_CASE("an edge of a cube is split where a corner of a shape in another region lies",
          "[model_writers][shapes]") {
  for (const std::string& ending : model_endings_written()) {
    CAPTURE(ending);
    const WrittenModel model = model_of(ending, shapes_at_regions(), shape_writing(2));
    const ModelPlace corner = {128, 1, 0.5};
    const auto is_of_stone = [&](const WrittenTriangle& t) {
      return t.colour == "120 121 122 255" &&
             std::count(t.places.begin(), t.places.end(), corner) != 0;
    };
    CHECK(std::any_of(model.triangles.begin(), model.triangles.end(), is_of_stone));
  }
}

TEST_CASE("a shape on a cube shows what the client draws", "[model_writers][shapes]") {
  // The slab shows no face to the stone, and the stone all of its own.
  const FileBuild build = file_build({1, 2, 1}, shape_materials(),
                                     [](VoxelPos at) { return at.y == 0 ? kStone : kSlab; });
  // A pane shows its ends to the air, and comes last.
  const FileBuild panes = file_build({3, 1, 1}, shape_materials(),
                                     [](VoxelPos at) { return at.x == 2 ? kTopStairs : kPane; });
  for (const std::string& ending : model_endings_written()) {
    CAPTURE(ending);
    CHECK(area_of(model_of(ending, build)) == 6 + 1 + 4 * 0.5);
    const WrittenModel model = model_of(ending, panes);
    double of_panes = 0;
    for (const WrittenTriangle& t : model.triangles) {
      if (t.colour == "240 250 255 50") of_panes += length_of(crossed_product(t)) / 2;
      if (ending[1] == 'g') CHECK(t.is_blended == (t.colour == "240 250 255 50"));
    }
    // Two sides, below, above, and the ends. The stairs fill only the upper half before one end, so
    // they do not hide it.
    CHECK(of_panes == Approx(2 * 2 + 2 * 2 * 2.0 / 16 + 2 * 2.0 / 16));
  }
}

TEST_CASE("a plane of a plant is one rectangle of a double-sided material, or one for each side",
          "[model_writers][shapes]") {
  std::vector<BuildMaterial> materials = {file_material("reed", "", {10, 200, 10, 255})};
  materials[0].row.shape = {ShapeForm::crossed, {{{1, 0, 4}, {15, 12, 12}}}};
  const FileBuild build = file_build({1, 1, 1}, materials, [](VoxelPos) { return 1; });
  const double length = std::hypot(14, 8) / 16, area = length * 12 / 16;
  for (const std::string& ending : model_endings_written()) {
    for (const unsigned choice : {0U, 3U, 4U}) {
      CAPTURE(ending, choice);
      const bool is_gltf = ending[1] == 'g';
      const WrittenModel model = model_of(ending, build, shape_writing(choice));
      CHECK(model.triangles.size() == (is_gltf ? 4U : 8U));
      CHECK(area_of(model) == Approx((is_gltf ? 2 : 4) * area));
      std::set<std::tuple<long, long, long>> normals;
      for (const WrittenTriangle& t : model.triangles) {
        CHECK(t.is_double_sided == is_gltf);
        const ModelPlace across = crossed_product(t);
        double along = 0;
        for (std::size_t i = 0; i < 3; ++i) along += across[i] / length_of(across) * t.normal[i];
        CHECK(along == Approx(1).margin(choice == 4 ? 0.01 : 1e-6));
        CHECK(length_of(t.normal) == Approx(1).margin(choice == 4 ? 0.01 : 1e-6));
        const auto rounded = [&](std::size_t i) { return std::lround(t.normal[i] * 100); };
        normals.insert({rounded(0), rounded(1), rounded(2)});
      }
      CHECK(normals.size() == (is_gltf ? 2U : 4U));
    }
  }
}

TEST_CASE("equal places of shapes share a vertex if vertices are welded",
          "[model_writers][shapes]") {
  SplitMix64 rng(4822);
  const FileBuild build = shapes_by_chance(rng, {20, 15, 20});
  for (const std::string ending : {".glb", ".ply"}) {
    const WrittenModel welded = model_of(ending, build);
    const WrittenModel apart = model_of(ending, build, shape_writing(1));
    CHECK(welded.triangles.size() == apart.triangles.size());
    CHECK(apart.vertex_count == 2 * apart.triangles.size());
    std::set<std::tuple<ModelPlace, ModelPlace, std::string>> different;
    for (const WrittenTriangle& t : welded.triangles) {
      for (const ModelPlace& place : t.places) different.insert({place, t.normal, t.colour});
    }
    CHECK(welded.vertex_count == different.size());
  }
  const WrittenModel obj = model_of(".obj", build);
  std::set<ModelPlace> places;
  for (const WrittenTriangle& t : obj.triangles) places.insert(t.places.begin(), t.places.end());
  CHECK(obj.vertex_count == places.size());
}

TEST_CASE("quantised places are voxels, and sixteenths of them only where shapes are",
          "[model_writers][shapes]") {
  const FileBuild build = shapes_at_regions();
  const Bytes file = model_bytes("a.glb", build, shape_writing(4));
  const std::string text(file.begin(), file.end());
  CHECK(text.find(R"("byteStride":12)") != std::string::npos);
  CHECK(text.find(R"("scale":[0.0625,0.0625,0.0625])") != std::string::npos);
  const FileBuild cubes =
      file_build({131, 2, 1}, shape_materials(), [](VoxelPos) { return kStone; });
  const Bytes other = model_bytes("a.glb", cubes, shape_writing(4));
  const std::string other_text(other.begin(), other.end());
  CHECK(other_text.find(R"("byteStride":8)") != std::string::npos);
  CHECK(other_text.find("0.0625") == std::string::npos);
  CHECK(area_of(model_of(".glb", build, shape_writing(4))) ==
        Approx(area_of(model_of(".glb", build))));
}

TEST_CASE("too many faces of shapes in one region are refused", "[model_writers][shapes]") {
  check_too_many(too_many_grains(), ".ply");
}

TEST_CASE("every writer refuses too many faces of shapes", "[.long][model_writers][shapes]") {
  const FileBuild build = too_many_grains();
  for (const std::string& ending : model_endings_written()) check_too_many(build, ending);
}

}  // namespace runstone::test
