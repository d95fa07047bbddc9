#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "common/core/hash.hpp"
#include "common/formats/look_material.hpp"
#include "common/voxelise/voxel_build.hpp"
#include "tests/support/voxelise/meshes.hpp"
#include "tests/support/voxelise/voxel_grid.hpp"

namespace runstone::test {
namespace {

using Colour3 = std::array<std::uint8_t, 3>;

VoxeliseOptions colour_options(bool is_solid, SurfaceMode surface) {
  VoxeliseOptions out;
  out.scale.voxels_per_unit = 1;
  out.is_solid = is_solid;
  out.surface = surface;
  return out;
}

Colour3 colour_at(const VoxelGrid& grid, VoxelPos p) {
  const Material material = grid.at(p);
  REQUIRE(material != kEmpty);
  return grid.result.colours[material - 1U];
}

/// A box whose sides have a material each: x low, x high, y low, y high, z low, z high.
Model painted_box(float side) {
  Model out = box_mesh({0, 0, 0}, {side, side, side});
  for (std::uint8_t i = 0; i < 6; ++i)
    out.materials.push_back({"side", {static_cast<std::uint8_t>(40 * i), 100, 200, 255}, {}});
  // The triangles of box_mesh(): z low, z high, y low, y high, x low, x high.
  for (const std::uint32_t side_of_box : {4U, 5U, 2U, 3U, 0U, 1U})
    out.material_of.insert(out.material_of.end(), 2, side_of_box);
  return out;
}

/// A square in the plane y = 0 with a texture.
Model textured_square(float side, ModelTexture texture) {
  Model out;
  out.positions = {{0, 0, 0}, {side, 0, 0}, {side, 0, side}, {0, 0, side}};
  out.texture_places = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  out.triangles = {{0, 2, 1}, {0, 3, 2}};
  out.material_of = {0, 0};
  out.materials.push_back({"cloth", {255, 255, 255, 255}, 0});
  out.textures.push_back(std::move(texture));
  return out;
}

}  // namespace

TEST_CASE("each side of a solid has the colour of its triangles", "[voxelise]") {
  // At 9.3 the far sides lie in voxels whose centres are outside, or in the last ones.
  for (const float side : {9.0F, 9.3F, 9.7F}) {
    CAPTURE(side);
    const auto grid = voxel_grid(painted_box(side), colour_options(true, SurfaceMode::none));
    REQUIRE(grid.has_value());
    const std::int32_t last = side > 9.5F ? 9 : 8;
    CHECK(colour_at(*grid, {0, 4, 4})[0] == 0);
    CHECK(colour_at(*grid, {last, 4, 4})[0] == 40);
    CHECK(colour_at(*grid, {4, 0, 4})[0] == 80);
    CHECK(colour_at(*grid, {4, last, 4})[0] == 120);
    CHECK(colour_at(*grid, {4, 4, 0})[0] == 160);
    CHECK(colour_at(*grid, {4, 4, last})[0] == 200);
    // The inside has the colour by which the row entered.
    CHECK(colour_at(*grid, {4, 4, 4})[0] == 0);
  }
}

TEST_CASE("a model with one colour has one material", "[voxelise]") {
  Model box = box_mesh({0, 0, 0}, {5, 5, 5});
  box.materials = {{"a", {9, 8, 7, 255}, {}}, {"b", {9, 8, 7, 100}, {}}};
  box.material_of.assign(12, 0);
  box.material_of[3] = 1;
  const auto grid = voxel_grid(box, colour_options(true, SurfaceMode::conservative));
  REQUIRE(grid.has_value());
  CHECK(grid->result.colours == std::vector<Colour3>{{9, 8, 7}});
  CHECK(grid->result.voxels == 125);
}

TEST_CASE("colours do not change the shape", "[voxelise]") {
  SplitMix64 rng{77};
  for (int round = 0; round < 30; ++round) {
    CAPTURE(round);
    Model mesh = random_closed_mesh(rng, 24);
    if (round % 3 == 0) mesh.triangles.resize(1 + mesh.triangles.size() / 2);
    VoxeliseOptions options;
    options.scale.longest_side = 20 + rng.below(60);
    options.is_solid = round % 4 != 1;
    options.surface = static_cast<SurfaceMode>(options.is_solid ? rng.below(4) : 1 + rng.below(3));
    options.colours_max = 1 + rng.below(300);
    const auto plain = voxel_grid(mesh, options);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const std::uint64_t bits = rng.next();
      mesh.colours.push_back({static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
                              static_cast<std::uint8_t>(bits >> 16), 255});
    }
    const auto coloured = voxel_grid(mesh, options);
    REQUIRE(plain.has_value());
    REQUIRE(coloured.has_value());
    bool equal = true;
    plain->for_each([&](VoxelPos p, Material material) {
      equal = equal && (material == kEmpty) == (coloured->at(p) == kEmpty);
    });
    CHECK(equal);
    CHECK(coloured->result.colours.size() <= options.colours_max);
  }
}

TEST_CASE("voxels have the texel at their place, and textures repeat", "[voxelise]") {
  ModelTexture texture{2, 2, {10, 0, 0, 255, 20, 0, 0, 255, 30, 0, 0, 255, 40, 0, 0, 255}};
  Model square = textured_square(8, texture);
  auto grid = voxel_grid(square, colour_options(false, SurfaceMode::conservative));
  REQUIRE(grid.has_value());
  CHECK(grid->result.voxels == 64);
  CHECK(colour_at(*grid, {1, 0, 1})[0] == 10);
  CHECK(colour_at(*grid, {6, 0, 1})[0] == 20);
  CHECK(colour_at(*grid, {1, 0, 6})[0] == 30);
  CHECK(colour_at(*grid, {6, 0, 6})[0] == 40);
  // Twice in each direction, from -1 on; the colour of the material is multiplied.
  for (auto& place : square.texture_places) {
    for (float& v : place) v = v * 2 - 1;
  }
  square.materials[0].colour = {51, 255, 255, 255};
  grid = voxel_grid(square, colour_options(false, SurfaceMode::conservative));
  REQUIRE(grid.has_value());
  CHECK(colour_at(*grid, {0, 0, 0})[0] == 2);
  CHECK(colour_at(*grid, {3, 0, 0})[0] == 4);
  CHECK(colour_at(*grid, {4, 0, 0})[0] == 2);
  CHECK(colour_at(*grid, {7, 0, 7})[0] == 8);
}

TEST_CASE("texels with alpha below 128 are no surface", "[voxelise]") {
  ModelTexture texture{2, 1, {10, 0, 0, 127, 20, 0, 0, 128}};
  const auto grid =
      voxel_grid(textured_square(8, texture), colour_options(false, SurfaceMode::conservative));
  REQUIRE(grid.has_value());
  // One triangle touches a voxel of the other half at the point of it where the texels meet.
  CHECK(grid->result.voxels == 33);
  CHECK(grid->at({3, 0, 4}) != kEmpty);
  CHECK(grid->at({1, 0, 1}) == kEmpty);
  CHECK(grid->at({6, 0, 1}) != kEmpty);
  // A solid without any surface to see has the colour of its material.
  Model box = box_mesh({0, 0, 0}, {4, 4, 4});
  box.texture_places.assign(8, {0, 0});
  box.materials.push_back({"glass", {1, 2, 3, 255}, 0});
  box.material_of.assign(12, 0);
  box.textures.push_back({1, 1, {255, 255, 255, 0}});
  const auto solid = voxel_grid(box, colour_options(true, SurfaceMode::conservative));
  REQUIRE(solid.has_value());
  CHECK(solid->result.voxels == 64);
  CHECK(solid->result.colours == std::vector<Colour3>{{1, 2, 3}});
}

TEST_CASE("the nearest of several triangles gives the colour", "[voxelise]") {
  Model two = textured_square(4, {1, 1, {255, 0, 0, 255}});
  Model upper = two;
  two.positions.push_back({0, 0.8F, 0});
  two.positions.push_back({4, 0.8F, 0});
  two.positions.push_back({4, 0.8F, 4});
  two.texture_places.resize(7);
  two.triangles.push_back({4, 6, 5});
  two.materials.push_back({"blue", {0, 0, 255, 255}, {}});
  two.material_of.push_back(1);
  const auto grid = voxel_grid(two, colour_options(false, SurfaceMode::conservative));
  REQUIRE(grid.has_value());
  // Its plane is at 0.8, which is nearer to 0.5 than 0 is.
  CHECK(colour_at(*grid, {3, 0, 0}) == Colour3{0, 0, 255});
  CHECK(colour_at(*grid, {0, 0, 3}) == Colour3{255, 0, 0});
}

TEST_CASE("colours between vertices are interpolated, and become few", "[voxelise]") {
  Model square = textured_square(64, {1, 1, {255, 255, 255, 255}});
  square.colours = {{0, 0, 0, 255}, {255, 0, 0, 255}, {255, 0, 0, 255}, {0, 0, 0, 255}};
  VoxeliseOptions options = colour_options(false, SurfaceMode::conservative);
  auto grid = voxel_grid(square, options);
  REQUIRE(grid.has_value());
  CHECK(grid->result.colours.size() == 64);
  CHECK(std::abs(int{colour_at(*grid, {10, 0, 30})[0]} - 42) <= 1);
  options.colours_max = 4;
  grid = voxel_grid(square, options);
  REQUIRE(grid.has_value());
  CHECK(grid->result.colours.size() == 4);
}

TEST_CASE("a cloud becomes balls with the colour of the nearest point", "[voxelise]") {
  Model cloud;
  cloud.positions = {{0, 0, 0}, {20, 20, 20}, {10.5F, 10.5F, 10.5F}, {12.5F, 10.5F, 10.5F}};
  cloud.colours = {{1, 1, 1, 255}, {2, 2, 2, 255}, {3, 3, 3, 255}, {4, 4, 4, 255}};
  VoxeliseOptions options = colour_options(true, SurfaceMode::none);
  options.point_radius = 0;
  auto grid = voxel_grid(cloud, options);
  REQUIRE(grid.has_value());
  CHECK(grid->result.sides == VoxelPos{20, 20, 20});
  CHECK(grid->result.voxels == 4);
  CHECK(colour_at(*grid, {19, 19, 19})[0] == 2);
  options.point_radius = 3;
  grid = voxel_grid(cloud, options);
  REQUIRE(grid.has_value());
  bool equal = true;
  grid->for_each([&](VoxelPos p, Material material) {
    double best = 1e9;
    std::uint8_t colour = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double dx = p.x + 0.5 - cloud.positions[i][0], dy = p.y + 0.5 - cloud.positions[i][1],
                   dz = p.z + 0.5 - cloud.positions[i][2];
      const double distance = std::sqrt(dx * dx + dy * dy + dz * dz);
      if (distance < best) {
        best = distance;
        colour = cloud.colours[i][0];
      }
    }
    equal = equal && (material != kEmpty) == (best <= 3) &&
            (material == kEmpty || grid->result.colours[material - 1U][0] == colour);
  });
  CHECK(equal);
}

TEST_CASE("a build of a model has materials named by colour", "[voxelise]") {
  const Model box = painted_box(70);
  const auto made = voxel_build(box, colour_options(true, SurfaceMode::none));
  REQUIRE(made.has_value());
  CHECK(made->build->sides() == VoxelPos{70, 70, 70});
  CHECK(made->build->touched() == 70 * 70 * 70);
  CHECK(made->materials.size() == 6);
  std::set<std::string> names;
  for (const MaterialRow& row : made->materials) {
    names.insert(row.name);
    // The name and the look that files of colours give.
    const MaterialInfo same = material_of_look({row.name, "", ForeignLook{row.colour}}, true);
    CHECK(row_of(same) == row);
  }
  CHECK(names.contains("colour #2864c8"));
  const auto at = made->build->at({69, 30, 30});
  REQUIRE(at);
  CHECK(made->materials[*at - 1U].name == "colour #2864c8");
  CHECK_FALSE(voxel_build(box, colour_options(true, SurfaceMode::none), 1'000).has_value());
  const auto none =
      voxel_build(box_mesh({0, 0, 0}, {9, 0.1F, 9}), colour_options(true, SurfaceMode::none));
  REQUIRE_FALSE(none.has_value());
  CHECK(none.error().code == ErrorCode::bad_value);
}

}  // namespace runstone::test
