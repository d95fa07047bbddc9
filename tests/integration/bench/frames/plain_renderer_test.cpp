// The cases draw off screen. If there is no OpenGL context, they say so with WARN and pass.
#include "bench/frames/gl/plain_renderer.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <set>
#include <string>

#include "bench/frames/frames_options.hpp"
#include "bench/frames/frames_world.hpp"
#include "bench/frames/gl/orbit.hpp"
#include "bench/meshing/mesher_case.hpp"
#include "bench/worlds/seeded_worlds.hpp"
#include "client/platform/egl_context.hpp"
#include "client/platform/gl_context.hpp"
#include "client/platform/osmesa_context.hpp"
#include "common/core/hash.hpp"

using namespace runstone;
using namespace runstone::bench;
using reference::Surface;

namespace {

constexpr int kWidth = 200, kHeight = 150;
using MakeContext = std::unique_ptr<GlContext> (*)(std::string&);

std::unique_ptr<GlContext> context_or_warn(MakeContext make) {
  std::string tried;
  auto context = make(tried);
  if (!context) WARN("no context: " << tried);
  return context;
}

/// Returns a camera 16 voxels above the middle of 0 .. 16 that looks down.
Camera above() {
  Camera camera;
  camera.x = camera.z = 8;
  camera.y = 24;
  camera.pitch = -1.5;
  camera.near = 1;
  camera.far = 100;
  return camera;
}

void add(PlainScene& scene, const Surface& surface) {
  IndexedMesh mesh;
  index_surface(surface, mesh);
  scene.add(glm::vec3{0}, 16, mesh);
}

/// Adds a triangle of a floor at height `y`.
void add_triangle(Surface& to, std::uint8_t y, std::array<std::array<std::uint8_t, 2>, 3> zx) {
  const auto first = static_cast<std::uint32_t>(to.triangles.vertices.size());
  for (const auto& [z, x] : zx) to.triangles.vertices.push_back({x, y, z});
  to.triangles.triangles.push_back({{first, first + 1, first + 2}, Direction::pos_y, 1});
}

/// Returns 4 for each block of 2 x 2 pixels in which anything was drawn.
std::size_t lanes_of(const DrawnPicture& picture) {
  std::set<std::pair<int, int>> blocks;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (picture.pixels[static_cast<std::size_t>(y * picture.width + x)] != 0)
        blocks.emplace(x / 2, y / 2);
    }
  }
  return 4 * blocks.size();
}

}  // namespace

TEST_CASE("fragments and lanes of one triangle are the pixels and blocks it covers", "[frames]") {
  const MakeContext make = GENERATE(&make_egl_surfaceless_context, &make_osmesa_context);
  const auto context = context_or_warn(make);
  if (!context) return;
  CAPTURE(context->name());
  PlainRenderer renderer(context->loader(), kWidth, kHeight);
  for (const std::array<std::array<std::uint8_t, 2>, 3>& corners :
       {std::array<std::array<std::uint8_t, 2>, 3>{{{0, 0}, {16, 0}, {0, 16}}},
        {{{0, 0}, {16, 0}, {0, 1}}},    // thin
        {{{0, 0}, {1, 15}, {0, 16}}},   // thin, not parallel to an axis
        {{{5, 5}, {6, 5}, {5, 6}}}}) {  // small
    Surface surface;
    add_triangle(surface, 8, corners);
    PlainScene scene;
    add(scene, surface);
    CHECK(scene.vertices() == 3);
    CHECK(scene.triangles() == 1);
    CHECK(scene.byte_size() == 3 * 8 + 3 * 4);
    renderer.draw(scene, above());
    const DrawnPicture picture = renderer.read();
    const std::size_t covered = covered_pixels(picture);
    CHECK(covered > 10);
    CHECK(renderer.fragments_drawn(scene, above()) == covered);
    CHECK(renderer.read().pixels == picture.pixels);
    CHECK(renderer.fragments_covered(scene, above()) == covered);
    const auto lanes = renderer.lanes_shaded(scene, above());
    if (!lanes) {
      WARN("no OpenGL 4.5");
      continue;
    }
    CHECK(*lanes == Approx(lanes_of(picture)).epsilon(1e-4));
  }
}

TEST_CASE("a lower fragment counts as covered, and as drawn only if it is drawn first",
          "[frames]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  PlainRenderer renderer(context->loader(), kWidth, kHeight);
  const Quad low = pack({4, 3, 4, 8, 8, Direction::pos_y, 1}),
             high = pack({4, 7, 4, 8, 8, Direction::pos_y, 2});
  const auto count = [&](const std::vector<Quad>& quads) {
    PlainScene scene;
    add(scene, {quads, {}});
    const std::uint64_t drawn = renderer.fragments_drawn(scene, above());
    const std::uint64_t picture = covered_pixels(renderer.read());
    return std::array<std::uint64_t, 3>{drawn, renderer.fragments_covered(scene, above()), picture};
  };
  const auto alone_low = count({low}), alone_high = count({high});
  CHECK(alone_low[0] < alone_high[0]);
  const auto near_first = count({high, low}), far_first = count({low, high});
  CHECK(near_first[0] == near_first[2]);
  CHECK(far_first[0] == alone_low[0] + alone_high[0]);
  CHECK(near_first[1] == far_first[1]);
  CHECK(near_first[1] == alone_low[0] + alone_high[0]);
  CHECK(near_first[2] == far_first[2]);
  // From behind nothing is visible.
  CHECK(count({pack({4, 3, 4, 8, 8, Direction::neg_y, 1})}) == std::array<std::uint64_t, 3>{});
}

TEST_CASE("every mesher draws the same picture", "[frames]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  PlainRenderer renderer(context->loader(), kWidth, kHeight);
  const auto worlds = seeded_worlds();
  const auto meshers = frames_meshers_by_default();
  for (const char* name : {"overhangs", "town"}) {
    const auto world = std::find_if(worlds.begin(), worlds.end(),
                                    [&](const VoxelWorld& w) { return w.name == name; });
    REQUIRE(world != worlds.end());
    const FramesWorld block = block_of(*world, {0, -16, 0}, {2, 2, 2}, 16);
    const auto scene_of = [&](std::string_view mesher, std::size_t without) {
      PlainScene scene;
      for (const FramesChunk& chunk : block.chunks) {
        const auto mesher_case = make_mesher_case(mesher, chunk.volume, *block.visibility);
        REQUIRE(mesher_case.has_value());
        PhaseTimes phases{};
        mesher_case->mesh(phases);
        Surface surface;
        mesher_case->surface(surface);
        surface.quads.resize(surface.quads.size() - std::min(without, surface.quads.size()));
        IndexedMesh mesh;
        index_surface(surface, mesh);
        const VoxelPos at = origin_of(chunk.at, 16);
        scene.add(glm::vec3{at.x, at.y, at.z}, 16, mesh);
      }
      return scene;
    };
    const PlainScene culled = scene_of("culled", 0);
    for (const std::string& mesher : meshers) {
      if (mesher == "product" || mesher == "quads") continue;
      const PlainScene scene = scene_of(mesher, 0), broken = scene_of(mesher, 60);
      for (unsigned frame = 0; frame < 5; ++frame) {
        CAPTURE(name, mesher, frame);
        const Camera at = orbit_camera({32, 32, 32}, frame, 5);
        renderer.draw(culled, at);
        const DrawnPicture expected = renderer.read();
        REQUIRE(covered_pixels(expected) > 1000);
        renderer.draw(scene, at);
        CHECK(difference_of(renderer.read(), expected).seam_pixels < 20);
        if (broken.triangles() == scene.triangles()) continue;
        renderer.draw(broken, at);
        CHECK(difference_of(renderer.read(), expected).seam_pixels > 20);
      }
    }
  }
}

TEST_CASE("packed quads give the picture of the same quads indexed, pixel by pixel", "[frames]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  PlainRenderer renderer(context->loader(), kWidth, kHeight);
  SplitMix64 rng(5);
  std::vector<Quad> quads;
  for (int i = 0; i < 200; ++i) {
    const auto below = [&rng](std::uint32_t bound) {
      return static_cast<std::uint8_t>(rng.below(bound));
    };
    QuadFields fields{below(128), below(128), below(128), 1, 1, static_cast<Direction>(below(6)),
                      1};
    fields.width = static_cast<std::uint8_t>(1 + below(128));
    fields.height = static_cast<std::uint8_t>(1 + below(128));
    // Quads of one plane may overlap, so all quads of a direction get one material.
    fields.material = static_cast<Material>(10000 * (1 + static_cast<unsigned>(fields.direction)));
    quads.push_back(pack(fields));
  }
  PlainScene packed, indexed;
  packed.add(glm::vec3{32, 0, 64}, 128, quads);
  IndexedMesh mesh;
  index_surface({quads, {}}, mesh);
  indexed.add(glm::vec3{32, 0, 64}, 128, mesh);
  CHECK(packed.vertices() == indexed.vertices());
  CHECK(packed.triangles() == indexed.triangles());
  CHECK(packed.byte_size() == 8 * quads.size());
  for (unsigned frame = 0; frame < 7; ++frame) {
    CAPTURE(frame);
    const Camera at = orbit_camera({160, 128, 192}, frame, 7);
    renderer.draw(indexed, at);
    const DrawnPicture expected = renderer.read();
    CHECK(covered_pixels(expected) > 1000);
    renderer.draw(packed, at);
    // The other diagonal gives another depth in the last bit where two planes cross.
    CHECK(difference_of(renderer.read(), expected).seam_pixels < 20);
    CHECK(renderer.fragments_covered(packed, at) == renderer.fragments_covered(indexed, at));
  }
}

TEST_CASE("the whole block is in view on the whole orbit", "[frames]") {
  const std::array<int, 3> size = {96, 64, 160};
  for (unsigned frame = 0; frame < 60; ++frame) {
    const glm::mat4 clip = clip_of(orbit_camera(size, frame, 60), 1280, 720);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec4 at = clip * glm::vec4{(corner & 1) * size[0], (corner >> 1 & 1) * size[1],
                                            (corner >> 2) * size[2], 1};
      CAPTURE(frame, corner);
      CHECK(at.w > 0);
      CHECK(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) <= at.w);
    }
  }
}
