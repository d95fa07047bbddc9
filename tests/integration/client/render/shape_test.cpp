// Shapes are drawn where the same boxes of whole voxels are, 16 times as large and as far away. The
// cases draw off screen. If there is no OpenGL context, they say so with WARN and pass.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "client/platform/egl_context.hpp"
#include "client/platform/osmesa_context.hpp"
#include "client/render/renderer.hpp"
#include "common/core/hash.hpp"
#include "common/mesh/quad.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kFineEdge = 32;  // two voxels of shapes
constexpr std::size_t kShapeCount = 8;
constexpr int kWidth = 200, kHeight = 150;

Shape random_shape(SplitMix64& rng) {
  Shape out;
  const std::size_t boxes = 1 + rng.below(3);
  while (out.boxes.size() < boxes) {
    ShapeBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.min[axis] = static_cast<std::uint8_t>(rng.below(kShapeUnits));
      box.max[axis] = static_cast<std::uint8_t>(
          box.min[axis] + 1 + rng.below(std::uint64_t{kShapeUnits} - box.min[axis]));
    }
    out.boxes.push_back(box);
  }
  return out;
}

/// The materials of the eight voxels of a cube of two voxels a side.
MaterialTable shaped_materials(SplitMix64& rng) {
  MaterialTable table;
  for (std::size_t i = 0; i < kShapeCount; ++i) {
    MaterialInfo row{"shape " + std::to_string(i), {220, 30, 30, 255}, Visibility::opaque, {}};
    row.shape = random_shape(rng);
    REQUIRE(table.add(std::move(row)).has_value());
  }
  return table;
}

std::array<std::uint8_t, 3> place_of(std::size_t i) {
  return {static_cast<std::uint8_t>(i & 1), static_cast<std::uint8_t>(i >> 1 & 1),
          static_cast<std::uint8_t>(i >> 2)};
}

/// Returns every face of the eight voxels as a quad.
ChunkMesh mesh_of_shapes(const MaterialTable& materials) {
  ChunkMesh out;
  for (std::size_t i = 0; i < kShapeCount; ++i) {
    const auto material = static_cast<Material>(i + 1);
    const ShapeFaces faces(materials[material].shape);
    const auto at = place_of(i);
    for (std::size_t face = 0; face < faces.faces().size(); ++face) {
      QuadFields quad{at[0], at[1], at[2], 1, 1, faces.faces()[face].direction, material};
      quad.face = static_cast<std::uint16_t>(face + 1);
      out.shapes.opaque.push_back(pack(quad));
    }
  }
  return out;
}

/// Returns the mesh of the same boxes, of voxels of one sixteenth.
ChunkMesh mesh_of_voxels(const MaterialTable& materials) {
  RunChunk chunk = uniform_chunk(Extent::cube(kFineEdge), kEmpty);
  for (std::size_t i = 0; i < kShapeCount; ++i) {
    const auto material = static_cast<Material>(i + 1);
    const auto at = place_of(i);
    for (const ShapeBox& box : materials[material].shape.boxes) {
      for (unsigned x = box.min[0]; x < box.max[0]; ++x) {
        for (unsigned y = box.min[1]; y < box.max[1]; ++y) {
          for (unsigned z = box.min[2]; z < box.max[2]; ++z) {
            const LocalPos fine{static_cast<std::uint8_t>(16 * at[0] + x),
                                static_cast<std::uint8_t>(16 * at[1] + y),
                                static_cast<std::uint8_t>(16 * at[2] + z)};
            fill(chunk, index_of(fine, chunk.extent, chunk.order), 1, material);
          }
        }
      }
    }
  }
  RdmScratch scratch;
  ChunkMesh out;
  mesh_rdm(chunk, {}, VisibilityTable({}), scratch, out);
  return out;
}

/// Returns true for each pixel that shows something red.
std::vector<bool> red_pixels(const Image& image) {
  std::vector<bool> out;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    out.push_back(image.rgb[i] > 1.3 * image.rgb[i + 1] && image.rgb[i] > 1.3 * image.rgb[i + 2]);
  return out;
}

std::vector<bool> drawn(GlContext& context, const MaterialTable& materials, const ChunkMesh& mesh,
                        const Camera& camera) {
  Renderer renderer(context.loader());
  renderer.set_materials(materials);
  renderer.upload({0, {0, 0, 0}}, kFineEdge, mesh);
  renderer.draw(camera, kWidth, kHeight);
  renderer.finish();
  return red_pixels(renderer.read_image());
}

/// A camera that looks at the middle of a cube with this side.
Camera at_cube(double side, double yaw, double pitch) {
  Camera out;
  out.yaw = yaw;
  out.pitch = pitch;
  const double distance = 1.6 * side, flat = std::cos(pitch);
  out.x = side / 2 - distance * std::sin(yaw) * flat;
  out.y = side / 2 - distance * std::sin(pitch);
  out.z = side / 2 - distance * std::cos(yaw) * flat;
  out.near = 0.05 * side;
  return out;
}

using MakeContext = std::unique_ptr<GlContext> (*)(std::string&);

}  // namespace

TEST_CASE("shapes are drawn where the boxes of their voxels are, on every headless path",
          "[render]") {
  const MakeContext make = GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context,
                                    &make_osmesa_context);
  std::string tried;
  const auto context = make(tried);
  if (!context) {
    WARN("no context: " << tried);
    return;
  }
  SplitMix64 rng{Catch::rngSeed() + 11};
  std::size_t red = 0, different = 0, pixels = 0;
  for (int round = 0; round < 6; ++round) {
    const MaterialTable materials = shaped_materials(rng);
    MaterialTable cubes;
    for (std::size_t i = 0; i < kShapeCount; ++i) {
      MaterialInfo row = materials[static_cast<Material>(i + 1)];
      row.shape = {};
      REQUIRE(cubes.add(std::move(row)).has_value());
    }
    const double yaw = 0.3 + 1.05 * round, pitch = round % 2 == 0 ? -0.5 : 0.6;
    const auto shapes =
        drawn(*context, materials, mesh_of_shapes(materials), at_cube(2, yaw, pitch));
    const auto voxels =
        drawn(*context, cubes, mesh_of_voxels(materials), at_cube(kFineEdge, yaw, pitch));
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      red += voxels[i] ? 1 : 0;
      different += shapes[i] != voxels[i] ? 1 : 0;
    }
    pixels += shapes.size();
  }
  CAPTURE(context->name(), red, different, pixels);
  CHECK(red > pixels / 50);
  CHECK(different <= red / 100);  // along outlines
}

TEST_CASE("a plant is seen from all sides, and equal faces in a row are one quad", "[render]") {
  std::string tried;
  const auto context = make_osmesa_context(tried);
  if (!context) {
    WARN("no context: " << tried);
    return;
  }
  MaterialTable materials;
  MaterialInfo plant{"plant", {220, 30, 30, 255}, Visibility::opaque, {}};
  plant.shape = {ShapeForm::crossed, {ShapeBox{}}};
  REQUIRE(materials.add(plant).has_value());
  MaterialInfo slab{"slab", {220, 30, 30, 255}, Visibility::opaque, {}};
  slab.shape = {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  REQUIRE(materials.add(slab).has_value());
  const auto count = [](const std::vector<bool>& red) {
    return std::count(red.begin(), red.end(), true);
  };
  const auto quads_of = [&](Material material, std::uint8_t width) {
    ChunkMesh out;
    const ShapeFaces faces(materials[material].shape);
    for (std::size_t i = 0; i < faces.faces().size(); ++i) {
      const ShapeFace& face = faces.faces()[i];
      if (material == 2 && face.direction != Direction::pos_y) continue;
      QuadFields quad{0, 0, 0, 1, 1, face.direction, material};
      quad.height = width;  // along v, which is x for a face upwards
      quad.face = static_cast<std::uint16_t>(i + 1);
      out.shapes.opaque.push_back(pack(quad));
    }
    return out;
  };
  for (const double yaw : {0.2, 1.8, 3.3, 4.9}) {
    CAPTURE(yaw);
    CHECK(count(drawn(*context, materials, quads_of(1, 1), at_cube(1, yaw, -0.2))) > 1000);
  }
  // Seen from above, a row of two is twice as wide as one.
  Camera down = at_cube(1, 0, 0);
  down.x = 1, down.y = 12, down.z = 0.5, down.pitch = -M_PI / 2;
  const auto one = count(drawn(*context, materials, quads_of(2, 1), down));
  const auto two = count(drawn(*context, materials, quads_of(2, 2), down));
  CHECK(one > 20);
  CHECK(std::abs(static_cast<double>(two) / static_cast<double>(one) - 2) < 0.15);
}

}  // namespace runstone
