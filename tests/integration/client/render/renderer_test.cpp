// The cases draw off screen. If there is no OpenGL context, they say so with WARN and pass.
#include "client/render/renderer.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>

#include "client/platform/egl_context.hpp"
#include "client/platform/osmesa_context.hpp"
#include "common/mesh/quad.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kEdge = 32;
constexpr Material kRed = 1;
constexpr Material kGlass = 2;

MaterialTable red_and_glass() {
  MaterialTable table;
  REQUIRE(table.add({"red", {220, 30, 30, 255}, Visibility::opaque, {}}).has_value());
  REQUIRE(table.add({"glass", {40, 80, 255, 128}, Visibility::transparent, {}}).has_value());
  return table;
}

void add(QuadLayers& layers, const QuadFields& quad) { layers.quads.push_back(pack(quad)); }

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
  renderer.set_materials(red_and_glass());
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
  const MakeContext make = GENERATE(&make_egl_surfaceless_context, &make_osmesa_context);
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
    ChunkMesh lacking = cube;
    lacking.opaque.quads.erase(lacking.opaque.quads.begin() + d);
    CHECK_FALSE(reddish(pixel(draw_with(*context, camera, lacking), 0.5, 0.5)));
  }
}

TEST_CASE("transparent quads blend over what lies behind them", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  ChunkMesh mesh = slab();
  add(mesh.transparent, {4, 8, 4, 8, 8, Direction::pos_y, kGlass});
  const auto bare = pixel(draw_with(*context, above(), slab()), 0.5, 0.5);
  const auto behind_glass = pixel(draw_with(*context, above(), mesh), 0.5, 0.5);
  CHECK(behind_glass[2] > bare[2] + 20);
  CHECK(behind_glass[0] < bare[0]);
  CHECK(behind_glass[0] > behind_glass[1]);
}

TEST_CASE("an empty mesh removes a chunk, and far worlds do not jitter", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  Renderer renderer(context->loader());
  renderer.set_materials(red_and_glass());
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

TEST_CASE("halving averages four pixels", "[render]") {
  const Image image{3, 2, {0, 0, 0, 100, 0, 0, 9, 9, 9, 0, 40, 0, 100, 0, 0, 9, 9, 9}};
  const Image half = halved(image);
  CHECK(half.width == 1);
  CHECK(half.height == 1);
  CHECK(half.rgb == std::vector<std::uint8_t>{50, 10, 0});
}

}  // namespace runstone
