// The cases draw off screen. If there is no OpenGL context, they say so with WARN and pass.
#include "client/render/renderer.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>

#include "client/platform/egl_context.hpp"
#include "client/platform/osmesa_context.hpp"
#include "common/core/hash.hpp"
#include "common/mesh/quad.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/integration/client/render/different_pixels.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kEdge = 32;
constexpr Material kRed = 1;
constexpr Material kGlass = 2;
constexpr Material kBlue = 3;

MaterialTable red_glass_and_blue() {
  MaterialTable table;
  REQUIRE(table.add({"red", {220, 30, 30, 255}, Visibility::opaque, {}}).has_value());
  REQUIRE(table.add({"glass", {40, 80, 255, 128}, Visibility::transparent, {}}).has_value());
  REQUIRE(table.add({"blue", {40, 80, 255, 255}, Visibility::opaque, {}}).has_value());
  return table;
}

/// Adds a quad at its place in the order of a mesh.
void add(QuadLayers& layers, const QuadFields& quad) {
  const std::array<std::uint8_t, 3> at = {quad.x, quad.y, quad.z};
  const std::size_t layer = static_cast<std::size_t>(quad.direction) * kSideMax +
                            at[static_cast<std::size_t>(axis_of(quad.direction))];
  layers.quads.insert(layers.quads.begin() + layers.first[layer + 1], pack(quad));
  for (std::size_t i = layer + 1; i < layers.first.size(); ++i) ++layers.first[i];
}

/// Returns the same faces, each as a quad of its own.
ChunkMesh cut_into_faces(const ChunkMesh& mesh) {
  ChunkMesh out;
  for (const Quad& quad : mesh.opaque.quads) {
    QuadFields face = unpack(quad);
    const Axis axis = axis_of(face.direction);
    const std::array<std::uint8_t*, 3> at = {&face.x, &face.y, &face.z};
    std::uint8_t& u = *at[static_cast<std::size_t>(u_axis_of(axis))];
    std::uint8_t& v = *at[static_cast<std::size_t>(v_axis_of(axis))];
    const int u0 = u, v0 = v, width = face.width, height = face.height;
    face.width = face.height = 1;
    for (int i = 0; i < width * height; ++i) {
      u = static_cast<std::uint8_t>(u0 + i % width);
      v = static_cast<std::uint8_t>(v0 + i / width);
      add(out.opaque, face);
    }
  }
  return out;
}

/// Returns a mesh with the six faces of the box [4, 4 + w) x [4, 5) x [4, 4 + h). A face of w x h
/// is one quad.
ChunkMesh slab() {
  ChunkMesh mesh;
  add(mesh.opaque, {4, 4, 4, 8, 8, Direction::pos_y, kRed});  // u = z, v = x
  add(mesh.opaque, {4, 4, 4, 8, 8, Direction::neg_y, kRed});
  return mesh;
}

std::array<int, 3> pixel(const Image& image, double u, double v) {
  const auto x = static_cast<std::size_t>(u * image.width);
  const auto y = static_cast<std::size_t>(v * image.height);
  const std::size_t at = (y * static_cast<std::size_t>(image.width) + x) * 3;
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

bool reddish(const std::array<int, 3>& p) { return p[0] > 1.5 * p[1] && p[0] > 1.5 * p[2]; }
bool is_sky(const std::array<int, 3>& p) { return p[2] >= p[0] && p[2] > 120; }

/// Returns a mesh with a red face a voxel before a blue wall, seen from below z, and another one seen
/// from above z. Quads of a direction are drawn in the order of z, so one red face is drawn before
/// its wall and the other one after it.
ChunkMesh faces_before_walls() {
  ChunkMesh mesh;
  add(mesh.opaque, {12, 12, 4, 8, 8, Direction::neg_z, kRed});
  add(mesh.opaque, {0, 0, 5, 32, 32, Direction::neg_z, kBlue});
  add(mesh.opaque, {0, 0, 24, 32, 32, Direction::pos_z, kBlue});
  add(mesh.opaque, {12, 12, 25, 8, 8, Direction::pos_z, kRed});
  return mesh;
}

Camera above() {
  Camera camera;
  camera.x = 8;
  camera.y = 16;
  camera.z = 8;
  camera.pitch = -M_PI / 2;
  return camera;
}

using MakeContext = std::unique_ptr<GlContext> (*)(std::string&);

Image draw_with(GlContext& context, const Camera& camera, const ChunkMesh& mesh,
                RenderStats* stats = nullptr) {
  Renderer renderer(context.loader());
  renderer.set_materials(red_glass_and_blue());
  renderer.upload({0, {0, 0, 0}}, kEdge, mesh);
  const RenderStats s = renderer.draw(camera, 160, 120);
  if (stats != nullptr) *stats = s;
  renderer.finish();
  return renderer.read_image();
}

std::unique_ptr<GlContext> context_or_warn(MakeContext make) {
  std::string tried;
  auto context = make(tried);
  if (!context) WARN("no context: " << tried);
  return context;
}

}  // namespace

TEST_CASE("a quad is drawn where its voxels are and nowhere else, on every headless path",
          "[render]") {
  const MakeContext make = GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context,
                                    &make_osmesa_context);
  const auto context = context_or_warn(make);
  if (!context) return;
  RenderStats stats;
  const Image image = draw_with(*context, above(), slab(), &stats);
  CAPTURE(context->name());
  CHECK(stats.chunks_drawn == 1);
  CHECK(reddish(pixel(image, 0.5, 0.5)));
  CHECK_FALSE(reddish(pixel(image, 0.05, 0.05)));
  CHECK_FALSE(reddish(pixel(image, 0.95, 0.5)));
}

TEST_CASE("faces are culled by their winding: a top face cannot be seen from below", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  ChunkMesh top;
  add(top.opaque, {4, 4, 4, 8, 8, Direction::pos_y, kRed});
  ChunkMesh bottom;
  add(bottom.opaque, {4, 4, 4, 8, 8, Direction::neg_y, kRed});
  Camera below = above();
  below.y = -6;
  below.pitch = M_PI / 2;
  CHECK(reddish(pixel(draw_with(*context, above(), top), 0.5, 0.5)));
  CHECK_FALSE(reddish(pixel(draw_with(*context, below, top), 0.5, 0.5)));
  CHECK(reddish(pixel(draw_with(*context, below, bottom), 0.5, 0.5)));
  CHECK_FALSE(reddish(pixel(draw_with(*context, above(), bottom), 0.5, 0.5)));
}

TEST_CASE("every direction faces outward: a cube looks closed from all six sides", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  ChunkMesh cube;
  for (int d = 0; d < kDirectionCount; ++d)
    add(cube.opaque, {8, 8, 8, 1, 1, static_cast<Direction>(d), kRed});
  for (int d = 0; d < kDirectionCount; ++d) {
    const auto direction = static_cast<Direction>(d);
    const double sign = is_positive(direction) ? 1 : -1;
    Camera camera;
    camera.x = 8.5;
    camera.y = 8.5;
    camera.z = 8.5;
    CAPTURE(d);
    switch (axis_of(direction)) {
      case Axis::x:
        camera.x += sign * 3;
        camera.yaw = -sign * M_PI / 2;
        break;
      case Axis::y:
        camera.y += sign * 3;
        camera.pitch = -sign * M_PI / 2;
        break;
      case Axis::z:
        camera.z += sign * 3;
        camera.yaw = sign > 0 ? M_PI : 0;
        break;
    }
    const Image image = draw_with(*context, camera, cube);
    CHECK(reddish(pixel(image, 0.5, 0.5)));
    // The oracle is broken on purpose: without this face the centre shows through.
    ChunkMesh lacking;
    for (int other = 0; other < kDirectionCount; ++other) {
      if (other != d) add(lacking.opaque, {8, 8, 8, 1, 1, static_cast<Direction>(other), kRed});
    }
    CHECK_FALSE(reddish(pixel(draw_with(*context, camera, lacking), 0.5, 0.5)));
  }
}

TEST_CASE(
    "faces a voxel apart are told apart from 10 to 32,768 voxels away, on every headless path",
    "[render]") {
  const MakeContext make = GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context,
                                    &make_osmesa_context);
  const auto context = context_or_warn(make);
  if (!context) return;
  const ChunkMesh mesh = faces_before_walls();
  for (const double distance : {10.0, 100.0, 2'048.0, 32'768.0}) {
    for (const bool from_below : {true, false}) {
      CAPTURE(context->name(), distance, from_below);
      Camera camera;
      camera.x = camera.y = 16;
      camera.z = from_below ? 4 - distance : 26 + distance;
      camera.yaw = from_below ? 0 : M_PI;
      camera.fov_y = 2 * std::atan(11 / (distance + 1));
      camera.far = 4 * 32'768;  // no fog
      const Image image = draw_with(*context, camera, mesh);
      CHECK(reddish(pixel(image, 0.5, 0.5)));
      const auto wall = pixel(image, 0.12, 0.5);
      CHECK_FALSE(reddish(wall));
      CHECK(wall[2] > 1.5 * wall[0]);
    }
  }
}

TEST_CASE("transparent quads blend over what lies behind them", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  ChunkMesh mesh = slab();
  add(mesh.transparent, {4, 8, 4, 8, 8, Direction::pos_y, kGlass});
  RenderStats without, with;
  const auto bare = pixel(draw_with(*context, above(), slab(), &without), 0.5, 0.5);
  const auto behind_glass = pixel(draw_with(*context, above(), mesh, &with), 0.5, 0.5);
  CHECK_FALSE(without.is_animated);
  CHECK(with.is_animated);
  CHECK(behind_glass[2] > bare[2] + 20);
  CHECK(behind_glass[0] < bare[0]);
  CHECK(behind_glass[0] > behind_glass[1]);
}

TEST_CASE("an empty mesh removes a chunk, and far worlds do not jitter", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  Renderer renderer(context->loader());
  renderer.set_materials(red_glass_and_blue());
  const ChunkKey far_key{0, {(1 << 28) / kEdge, 0, -((1 << 28) / kEdge)}};
  renderer.upload(far_key, kEdge, slab());
  Camera camera = above();
  camera.x += 1 << 28;
  camera.z -= 1 << 28;
  renderer.draw(camera, 160, 120);
  const Image far_image = renderer.read_image();
  CHECK(far_image.rgb == draw_with(*context, above(), slab()).rgb);
  renderer.upload(far_key, kEdge, ChunkMesh{});
  CHECK(renderer.draw(camera, 160, 120).chunks_drawn == 0);
  CHECK_FALSE(reddish(pixel(renderer.read_image(), 0.5, 0.5)));
}

TEST_CASE("the sky fills a frame without chunks", "[render]") {
  const auto context = context_or_warn(&make_osmesa_context);
  if (!context) return;
  Renderer renderer(context->loader());
  Camera camera;
  camera.pitch = 0.3;
  renderer.draw(camera, 64, 48);
  CHECK(is_sky(pixel(renderer.read_image(), 0.5, 0.5)));
}

TEST_CASE("an overlay is drawn over the frame, in its place, clipped and blended, on every path",
          "[render]") {
  const MakeContext make = GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context,
                                    &make_osmesa_context);
  const auto context = context_or_warn(make);
  if (!context) return;
  Renderer renderer(context->loader());
  Camera camera;
  camera.pitch = 0.3;
  renderer.draw(camera, 160, 120);
  const Image without = renderer.read_image();
  OverlayFrame overlay;
  overlay.width = 160;
  overlay.height = 120;
  overlay.atlas =
      std::make_shared<const OverlayAtlas>(OverlayAtlas{2, 1, std::vector<std::uint8_t>{255, 0}});
  // A green square in the upper left quarter, whose lower half is clipped, and one beside it whose
  // glyph has no coverage.
  const auto square = [&overlay](float left, float u, std::array<float, 4> clip) {
    const auto vertex = static_cast<std::uint32_t>(overlay.vertices.size());
    const auto index = static_cast<std::uint32_t>(overlay.indices.size());
    constexpr std::uint32_t kGreen = 0xFF00FF00;
    for (const auto& [x, y] :
         {std::pair{left, 0.F}, {left + 80, 0.F}, {left + 80, 60.F}, {left, 60.F}})
      overlay.vertices.push_back({x, y, u, 0.5F, kGreen});
    overlay.indices.insert(overlay.indices.end(), {0, 1, 2, 0, 2, 3});
    overlay.commands.push_back({clip, index, 6, vertex});
  };
  square(0, 0.25F, {0, 0, 160, 30});
  square(80, 0.75F, {0, 0, 160, 120});
  renderer.draw_overlay(overlay);
  renderer.finish();
  const Image with = renderer.read_image();
  const std::array<int, 3> green{0, 255, 0};
  CHECK(pixel(with, 0.02, 0.02) == green);
  CHECK(pixel(with, 0.48, 0.23) == green);
  CHECK(pixel(with, 0.25, 0.27) == pixel(without, 0.25, 0.27));
  CHECK(pixel(with, 0.75, 0.25) == pixel(without, 0.75, 0.25));
  // What is drawn next is not changed by it.
  renderer.draw(camera, 160, 120);
  CHECK(renderer.read_image().rgb == without.rgb);
}

TEST_CASE("an overlay shows images in their colours, and another image in the next frame",
          "[render]") {
  const MakeContext make = GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context,
                                    &make_osmesa_context);
  const auto context = context_or_warn(make);
  if (!context) return;
  Renderer renderer(context->loader());
  Camera camera;
  camera.pitch = 0.3;
  renderer.draw(camera, 160, 120);
  const Image without = renderer.read_image();
  OverlayFrame overlay;
  overlay.width = 160;
  overlay.height = 120;
  overlay.atlas =
      std::make_shared<const OverlayAtlas>(OverlayAtlas{1, 1, std::vector<std::uint8_t>{255}});
  // Red, and a pixel without colour.
  const auto two = [](std::uint32_t first) {
    return std::make_shared<const OverlayImage>(OverlayImage{2, 1, {first, 0x00FFFFFF}});
  };
  overlay.images = {two(0xFF0000FF)};
  for (const auto& [x, y] : {std::pair{0.F, 0.F}, {160.F, 0.F}, {160.F, 120.F}, {0.F, 120.F}})
    overlay.vertices.push_back({x, y, x / 160, 0.5F, 0xFFFFFFFF});
  overlay.indices = {0, 1, 2, 0, 2, 3};
  overlay.commands = {{{0, 0, 160, 120}, 0, 6, 0, 1}};
  renderer.draw_overlay(overlay);
  renderer.finish();
  const Image with = renderer.read_image();
  CHECK(pixel(with, 0.1, 0.5) == std::array<int, 3>{255, 0, 0});
  CHECK(pixel(with, 0.45, 0.9) == std::array<int, 3>{255, 0, 0});
  CHECK(pixel(with, 0.75, 0.5) == pixel(without, 0.75, 0.5));
  renderer.draw(camera, 160, 120);
  overlay.images = {two(0xFFFF0000)};
  renderer.draw_overlay(overlay);
  renderer.finish();
  CHECK(pixel(renderer.read_image(), 0.1, 0.5) == std::array<int, 3>{0, 0, 255});
}

TEST_CASE("corners are dark next to opaque voxels, however the faces are cut into quads",
          "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  // A floor with scattered blocks, across two chunks.
  const VisibilityTable visibility(visibilities(red_glass_and_blue()));
  SplitMix64 rng(9);
  std::array<RunChunk, 2> chunks = {uniform_chunk(Extent::cube(kEdge), kEmpty, AxisOrder::xzy),
                                    uniform_chunk(Extent::cube(kEdge), kEmpty, AxisOrder::yzx)};
  for (RunChunk& chunk : chunks) {
    for (int x = 0; x < kEdge; ++x) {
      for (int z = 0; z < kEdge; ++z) {
        const int height = rng.below(4) == 0 ? 3 : 2;
        for (int y = 0; y < height; ++y) {
          const LocalPos at{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                            static_cast<std::uint8_t>(z)};
          fill(chunk, index_of(at, chunk.extent, chunk.order), 1, kRed);
        }
      }
    }
  }
  const auto picture = [&](bool cut, bool with_voxels) {
    Renderer renderer(context->loader());
    renderer.set_materials(red_glass_and_blue());
    RdmScratch scratch;
    for (int i = 0; i < 2; ++i) {
      ChunkMesh mesh;
      MeshNeighbours beside{};
      beside[static_cast<std::size_t>(i == 0 ? Direction::pos_x : Direction::neg_x)] =
          &chunks[static_cast<std::size_t>(1 - i)];
      const RunChunk& chunk = chunks[static_cast<std::size_t>(i)];
      mesh_rdm(chunk, beside, visibility, scratch, mesh);
      if (cut) mesh = cut_into_faces(mesh);
      renderer.upload({0, {i, 0, 0}}, kEdge, mesh, with_voxels ? &chunk : nullptr);
    }
    Camera camera;
    camera.x = 31.5, camera.y = 9, camera.z = 4.5;
    camera.pitch = -0.7;
    FrameContents contents;
    contents.look.time_of_day = 0.5;
    renderer.draw(camera, 320, 240, contents);
    renderer.finish();
    return renderer.read_image();
  };
  const Image merged = picture(false, true);
  // Some pixels at the outlines of blocks are rounded differently.
  CHECK(different_pixels(merged, picture(true, true)) <= 16);
  CHECK(different_pixels(merged, picture(false, false)) > 2000);
}

TEST_CASE("an inspection is drawn over the faces that it is about, and leaves no trace",
          "[render]") {
  const MakeContext make =
      GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context);
  const auto context = context_or_warn(make);
  if (!context) return;
  // A floor of one material. A second material is a run of its own within it.
  RunChunk chunk = uniform_chunk(Extent::cube(kEdge), kEmpty, AxisOrder::xzy);
  fill(chunk, 0, kEdge * kEdge, kRed);
  fill(chunk, index_of({12, 0, 12}, chunk.extent, chunk.order), 6, 3);
  const auto voxels = std::make_shared<const RunChunk>(chunk);
  const ChunkKey key{0, {0, 0, 0}};
  Renderer renderer(context->loader());
  MaterialTable materials = red_glass_and_blue();
  REQUIRE(materials.add({"maroon", {200, 30, 30, 255}, Visibility::opaque, {}}).has_value());
  renderer.set_materials(materials);
  RdmScratch scratch;
  ChunkMesh mesh;
  mesh_rdm(chunk, {}, VisibilityTable(visibilities(materials)), scratch, mesh);
  renderer.upload(key, kEdge, mesh, voxels.get());
  Camera camera = above();
  camera.x = 16.3, camera.z = 16.4, camera.y = 14;
  const auto picture = [&](const Inspection& inspection) {
    FrameContents contents;
    contents.look.quality = Quality::low;
    contents.inspection = inspection;
    renderer.draw(camera, 320, 240, contents);
    renderer.finish();
    return renderer.read_image();
  };
  const Image plain = picture({});
  const auto changed = [&](const Inspection& inspection) {
    return different_pixels(plain, picture(inspection));
  };
  constexpr std::size_t kAll = 320 * 240;

  Inspection wireframe;
  wireframe.modes.set(InspectionMode::wireframe, true);
  CHECK(changed(wireframe) > 200);
  CHECK(changed(wireframe) < kAll / 4);  // lines, not faces

  Inspection orders;
  orders.modes.set(InspectionMode::orders, true);
  CHECK(changed(orders) == 0);  // it has no chunk
  orders.chunks.push_back({key, voxels, false});
  CHECK(changed(orders) > kAll * 9 / 10);

  Inspection runs;
  runs.modes.set(InspectionMode::runs, true);
  runs.chunks.push_back({key, voxels, true});
  const std::size_t with_two_starts = changed(runs);
  CHECK(with_two_starts > 20);
  CHECK(with_two_starts < kAll / 20);
  // The pattern is that of the runs: other runs in the same order give another one.
  RunChunk cut = chunk;
  for (std::uint8_t x = 0; x < kEdge; x += 2)
    fill(cut, index_of({x, 0, 14}, cut.extent, cut.order), 1, 3);
  runs.chunks[0].voxels = std::make_shared<const RunChunk>(cut);
  CHECK(changed(runs) > 2 * with_two_starts);

  Inspection layers;
  layers.modes.set(InspectionMode::layers, true);
  FlashedLayers flash{key, {}, 1.0F};
  flash.layers.layer[0].set(16);
  layers.flashes.push_back(flash);
  const std::size_t one_layer = changed(layers);
  CHECK(one_layer > 100);
  CHECK(one_layer < kAll / 8);
  layers.flashes[0].strength = 0;
  CHECK(changed(layers) == 0);

  CHECK(picture({}).rgb == plain.rgb);
}

TEST_CASE("all headless paths draw the same picture", "[render]") {
  const auto egl = context_or_warn(&make_egl_surfaceless_context);
  if (!egl) return;
  ChunkMesh mesh = slab();
  add(mesh.transparent, {4, 8, 4, 8, 8, Direction::pos_y, kGlass});
  const Image by_egl = draw_with(*egl, above(), mesh);
  const MakeContext make = GENERATE(&make_egl_surfaceless_es_context, &make_osmesa_context);
  const auto other = context_or_warn(make);
  if (!other) return;
  CAPTURE(other->name());
  CHECK(different_pixels(by_egl, draw_with(*other, above(), mesh)) <= 5);
}

TEST_CASE("a wall throws a shadow away from the sun, and an edit takes it away", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  Renderer renderer(context->loader());
  renderer.set_materials(red_glass_and_blue());
  ChunkMesh floor;
  add(floor.opaque, {0, 0, 0, 32, 32, Direction::pos_y, kRed});
  ChunkMesh wall = floor;
  // The morning sun stands at +x; the wall at x = 16 faces it and is 8 high.
  add(wall.opaque, {16, 1, 0, 8, 32, Direction::pos_x, kRed});
  Camera camera;
  camera.x = 16, camera.y = 40, camera.z = 16;
  camera.pitch = -M_PI / 2;
  FrameContents contents;
  contents.look.time_of_day = 0.375;
  const auto brightness = [&](const ChunkMesh& mesh, Quality quality) {
    renderer.upload({0, {0, 0, 0}}, kEdge, mesh);
    contents.look.quality = quality;
    renderer.draw(camera, 160, 120, contents);
    return renderer.read_image();
  };
  const Image open = brightness(floor, Quality::high);
  const Image shaded = brightness(wall, Quality::high);
  const Image unshaded = brightness(wall, Quality::low);
  const std::size_t in_shadow = different_pixels(open, shaded);
  CHECK(in_shadow > 800);
  CHECK(in_shadow < 9000);
  CHECK(different_pixels(unshaded, brightness(floor, Quality::low)) < 400);
  CHECK(different_pixels(open, brightness(floor, Quality::high)) == 0);
}

TEST_CASE("in a window, shadows of many quads follow an edit within some frames", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  Renderer renderer(context->loader());
  renderer.set_materials(red_glass_and_blue());
  ChunkMesh floor;  // three chunks of it have more quads than a frame draws into a shadow map
  for (std::uint8_t x = 0; x < 32; ++x) {
    for (std::uint8_t z = 0; z < 32; ++z)
      add(floor.opaque, {x, 0, z, 1, 1, Direction::pos_y, kRed});
  }
  for (const std::int32_t x : {-1, 0, 1}) renderer.upload({0, {x, 0, 0}}, kEdge, floor);
  Camera camera;
  camera.x = 16, camera.y = 40, camera.z = 16;
  camera.pitch = -M_PI / 2;
  FrameContents contents;
  contents.look.time_of_day = 0.375;
  const auto picture = [&](bool is_exact) {
    contents.look.exact = is_exact;
    renderer.draw(camera, 160, 120, contents);
    return renderer.read_image();
  };
  const Image open = picture(false);  // the first maps are drawn at once
  CHECK(different_pixels(open, picture(true)) == 0);
  ChunkMesh wall = floor;
  add(wall.opaque, {16, 1, 0, 8, 32, Direction::pos_x, kRed});
  renderer.upload({0, {0, 0, 0}}, kEdge, wall);
  const Image at_once = picture(false);
  unsigned frames = 1;
  Image later = at_once;
  while (different_pixels(open, later) < 800 && frames < 20) {
    later = picture(false);
    ++frames;
  }
  CHECK(frames > 1);
  CHECK(frames <= 4);
  for (unsigned i = 0; i < 4; ++i) later = picture(false);
  CHECK(different_pixels(later, picture(true)) == 0);
  CHECK(different_pixels(open, later) > 800);
}

TEST_CASE("a ghost shows removed voxels in red and placed ones in their colour", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  Renderer renderer(context->loader());
  renderer.set_materials(red_glass_and_blue());
  ChunkMesh placed;
  add(placed.transparent, {4, 4, 4, 8, 8, Direction::pos_y, kGlass});
  ChunkMesh removed;
  add(removed.opaque, {4, 4, 4, 8, 8, Direction::pos_y, kGlass});
  // Returns the colour at a place within the cell (8, 4, 8).
  const auto shown = [&](const GhostChunk& ghost, double x, double z) {
    FrameContents contents;
    if (ghost.edge != 0) contents.ghosts.push_back(ghost);
    Camera camera = above();
    camera.x += x;
    camera.z += z;
    camera.fov_y = 0.1;  // a pixel is less than a hundredth of a cell
    renderer.draw(camera, 160, 120, contents);
    return pixel(renderer.read_image(), 0.5, 0.5);
  };
  const auto redness = [](const std::array<int, 3>& p) { return p[0] - p[2]; };
  const ChunkKey key{0, {0, 0, 0}};
  const GhostChunk blue{key, kEdge, std::make_shared<const ChunkMesh>(placed), nullptr};
  const GhostChunk red{key, kEdge, nullptr, std::make_shared<const ChunkMesh>(removed)};
  const auto none = shown({}, 0.25, 0.5);
  const auto beside_blue = shown(blue, 0.25, 0.5), beside_red = shown(red, 0.25, 0.5);
  CHECK(redness(beside_blue) < redness(none) - 30);
  CHECK(redness(beside_red) > redness(none) + 30);
  // A removed voxel has a cross of two diagonals, and a placed one has none.
  for (const double x : {0.25, 0.75}) {
    CAPTURE(x);
    CHECK(shown(red, x, 0.25)[1] > beside_red[1] + 15);
    CHECK(std::abs(shown(blue, x, 0.25)[1] - beside_blue[1]) <= 4);
  }
  CHECK(shown({}, 0.25, 0.5) == none);
}

TEST_CASE("a ghost far away has no pattern of lines", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  Renderer renderer(context->loader());
  renderer.set_materials(red_glass_and_blue());
  ChunkMesh placed;
  add(placed.opaque, {0, 4, 0, 32, 32, Direction::pos_y, kRed});
  const auto mesh = std::make_shared<const ChunkMesh>(placed);
  // Returns the difference of the brightest and the darkest pixel of the middle of the ghost.
  const auto contrast = [&](double height) {
    FrameContents contents;
    contents.ghosts.push_back({{0, {0, 0, 0}}, kEdge, mesh, nullptr});
    Camera camera = above();
    camera.x = camera.z = 16;
    camera.y = height;
    renderer.draw(camera, 160, 120, contents);
    const Image image = renderer.read_image();
    int low = 255, high = 0;
    for (int x = -3; x <= 3; ++x) {
      for (int y = -3; y <= 3; ++y) {
        const int green = pixel(image, 0.5 + x / 160.0, 0.5 + y / 120.0)[1];
        low = std::min(low, green);
        high = std::max(high, green);
      }
    }
    return high - low;
  };
  CHECK(contrast(8) > 20);  // lines between cells
  CHECK(contrast(205) <= 4);
}

TEST_CASE("halving averages four pixels", "[render]") {
  const Image image{3, 2, {0, 0, 0, 100, 0, 0, 9, 9, 9, 0, 40, 0, 100, 0, 0, 9, 9, 9}};
  const Image half = halved(image);
  CHECK(half.width == 1);
  CHECK(half.height == 1);
  CHECK(half.rgb == std::vector<std::uint8_t>{50, 10, 0});
}

}  // namespace runstone
