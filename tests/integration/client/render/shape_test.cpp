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
#include "client/render/transparent_tree.hpp"
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

TEST_CASE("a joined inner face whose other side begins inside of the voxel is drawn in its place",
          "[render]") {
  std::string tried;
  const auto context = make_osmesa_context(tried);
  if (!context) {
    WARN("no context: " << tried);
    return;
  }
  // A beam along x. Its upper face lies inside of the voxel, goes from 4 to 12 along z, which is u
  // there, and joins along x, which is v.
  MaterialTable materials, cubes;
  MaterialInfo beam{"beam", {220, 30, 30, 255}, Visibility::opaque, {}};
  REQUIRE(cubes.add(beam).has_value());
  beam.shape = {ShapeForm::boxes, {{{0, 4, 4}, {16, 9, 12}}}};
  REQUIRE(materials.add(beam).has_value());
  ChunkMesh shapes, voxels;
  const ShapeFaces faces(beam.shape);
  for (std::size_t i = 0; i < faces.faces().size(); ++i) {
    const ShapeFace& face = faces.faces()[i];
    QuadFields quad{0, 0, 0, 1, 1, face.direction, 1};
    quad.face = static_cast<std::uint16_t>(i + 1);
    if (face.direction == Direction::pos_y) {
      REQUIRE(face.u0 == 4);
      REQUIRE(face.depth == 9);
      quad.height = 2;
    } else if (face.direction == Direction::pos_z) {
      REQUIRE(face.v0 == 4);
      quad.width = 2;
    } else {
      continue;
    }
    shapes.shapes.opaque.push_back(pack(quad));
  }
  REQUIRE(shapes.shapes.opaque.size() == 2);
  // The same faces, of voxels of one sixteenth. Widths are along u, heights along v.
  voxels.opaque.quads = {pack({0, 8, 4, 8, 32, Direction::pos_y, 1}),
                         pack({0, 4, 11, 32, 5, Direction::pos_z, 1})};
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    for (std::size_t layer = 0; layer < kSideMax; ++layer) {
      const std::size_t at = d * kSideMax + layer;
      const auto up = static_cast<std::size_t>(Direction::pos_y) * kSideMax + 8;
      const auto south = static_cast<std::size_t>(Direction::pos_z) * kSideMax + 11;
      voxels.opaque.first[at] = (at > up ? 1U : 0U) + (at > south ? 1U : 0U);
    }
  }
  voxels.opaque.first.back() = 2;
  std::size_t red = 0, different = 0;
  for (const double yaw : {-0.6, 0.1, 0.7}) {
    const auto a = drawn(*context, materials, shapes, at_cube(2, yaw + M_PI, -0.7));
    const auto b = drawn(*context, cubes, voxels, at_cube(kFineEdge, yaw + M_PI, -0.7));
    for (std::size_t i = 0; i < a.size(); ++i) {
      red += b[i] ? 1 : 0;
      different += a[i] != b[i] ? 1 : 0;
    }
  }
  CAPTURE(red, different);
  CHECK(red > 1000);
  CHECK(different <= red / 50);  // along outlines
}

TEST_CASE("transparent shapes are drawn with a tree and without one", "[render]") {
  std::string tried;
  const auto context = make_osmesa_context(tried);
  if (!context) {
    WARN("no context: " << tried);
    return;
  }
  MaterialTable materials;
  MaterialInfo pane{"pane", {220, 30, 30, 200}, Visibility::transparent, {}};
  pane.shape = {ShapeForm::boxes, {{{0, 0, 7}, {16, 16, 9}}}};
  REQUIRE(materials.add(pane).has_value());
  const ShapeFaces faces(pane.shape);
  const auto panes = [&](std::size_t times) {
    ChunkMesh out;
    for (std::size_t time = 0; time < times; ++time) {
      for (std::size_t i = 0; i < faces.faces().size(); ++i) {
        const ShapeFace& face = faces.faces()[i];
        if (face.direction != Direction::pos_z) continue;
        // The other panes lie beside the picture.
        QuadFields quad{0, 0, 0, 1, 1, face.direction, 1};
        if (time > 0) quad.x = static_cast<std::uint8_t>(16 + time % 16);
        if (time > 0) quad.z = static_cast<std::uint8_t>(time / 16 % 32);
        quad.face = static_cast<std::uint16_t>(i + 1);
        out.shapes.transparent.push_back(pack(quad));
      }
    }
    return out;
  };
  const auto count = [](const std::vector<bool>& red) {
    return std::count(red.begin(), red.end(), true);
  };
  // A camera near the first pane, which sees no other.
  Camera near = at_cube(1, M_PI, 0);
  const auto alone = count(drawn(*context, materials, panes(1), near));
  CHECK(alone > 1000);
  // More quads than a tree takes.
  const std::size_t many = TransparentTree::kQuadsMax + 1;
  const ChunkMesh mesh = panes(many);
  REQUIRE_FALSE(TransparentTree::build(mesh.shapes.transparent, ShapeTable(shapes_of(materials))));
  const auto with_others = count(drawn(*context, materials, mesh, near));
  CHECK(with_others >= alone);
  CHECK(with_others < alone + alone / 2);
  CHECK(count(drawn(*context, materials, ChunkMesh{}, near)) == 0);
}

}  // namespace runstone
