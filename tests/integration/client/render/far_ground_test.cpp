// Distant ground: a landscape of chunks near the eye and tiles around them. Pixels that must show
// ground are searched for the sky. If there is no OpenGL context, the case says so with WARN and
// passes. The hidden case [.pictures] draws pictures to look at: RUNSTONE_PICTURES names their
// folder, and RUNSTONE_LEVELS the levels of the view.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "client/far/far_fades.hpp"
#include "client/far/far_reach.hpp"
#include "client/platform/egl_context.hpp"
#include "client/platform/osmesa_context.hpp"
#include "client/render/image.hpp"
#include "client/render/png_file.hpp"
#include "common/core/hash.hpp"
#include "tests/integration/client/render/far_world.hpp"

namespace runstone::test {
namespace {

constexpr int kPlaceWidth = 320, kPlaceHeight = 200;

/// Returns the default materials, all opaque and red, so that no ground looks like the sky.
MaterialTable red_materials() {
  MaterialTable out;
  const MaterialTable& all = default_material_table();
  for (std::size_t i = out.size(); i < all.size(); ++i) {
    MaterialInfo row = all[static_cast<Material>(i)];
    row.colour = {200, 20, 10, 255};
    row.visibility = Visibility::opaque;
    row.look = {};
    REQUIRE(out.add(row).has_value());
  }
  return out;
}

/// Returns the direction of a pixel.
std::array<double, 3> ray_of(const Camera& camera, int x, int y) {
  const double up = std::tan(camera.fov_y / 2);
  const double v = (1 - 2 * (y + 0.5) / kPlaceHeight) * up;
  const double u = (2 * (x + 0.5) / kPlaceWidth - 1) * up * kPlaceWidth / kPlaceHeight;
  const double sine = std::sin(camera.yaw), cosine = std::cos(camera.yaw);
  const double level = std::cos(camera.pitch) - v * std::sin(camera.pitch);
  const double height = std::sin(camera.pitch) + v * std::cos(camera.pitch);
  return {sine * level - cosine * u, height, cosine * level + sine * u};
}

bool is_red(const Image& image, int x, int y) {
  const std::size_t at = static_cast<std::size_t>(y * image.width + x) * 3;
  return image.rgb[at] > 2 * image.rgb[at + 2];
}

struct HorizonCount {
  std::size_t ground = 0, sky = 0;  // pixels that must show ground, and those of them that do not
};

/// Counts the pixels that look at ground within the reach of the view. A ray that falls below the
/// lowest surface within the reach has met ground.
HorizonCount count_sky(const Image& image, const Camera& camera, double lowest, double reach) {
  HorizonCount out;
  for (int y = 0; y < kPlaceHeight; ++y) {
    for (int x = 0; x < kPlaceWidth; ++x) {
      const auto ray = ray_of(camera, x, y);
      if (ray[1] >= 0) continue;
      const double far = (camera.y - lowest) / -ray[1] * std::hypot(ray[0], ray[2]);
      if (far > reach) continue;
      ++out.ground;
      out.sky += is_red(image, x, y) ? 0 : 1;
    }
  }
  return out;
}

FrameContents noon_with_fades() {
  FrameContents out;
  out.look.time_of_day = 0.5;
  out.look.quality = Quality::medium;
  out.look.exact = false;
  return out;
}

}  // namespace

TEST_CASE("no pixel shows the sky through the ground, at the borders of levels and between them",
          "[render][far]") {
  std::string tried;
  const auto context = make_egl_surfaceless_context(tried);
  if (!context) {
    WARN("no context: " << tried);
    return;
  }
  // A dry landscape with steep ground.
  FarWorld world(16, red_materials(), "water = \"\"\nbeach = \"\"\n");
  Renderer renderer(context->loader());
  FarScene scene(world, renderer);
  SplitMix64 rng{Catch::rngSeed()};
  HorizonCount total;
  std::uint32_t parts_most = 0;
  for (int place = 0; place < 100; ++place) {
    const auto at = [&] { return rng.between(-40, 40) + rng.below(1000) / 1000.0; };
    Camera camera;
    camera.x = at();
    camera.z = at();
    const auto surface = [&](double x, double z) {
      return world.generator().surface_y(static_cast<std::int32_t>(std::floor(x)),
                                         static_cast<std::int32_t>(std::floor(z)));
    };
    camera.y = surface(camera.x, camera.z) + (place % 3 == 0 ? 2.5 : 8.0 + rng.below(60));
    camera.yaw = rng.below(628) / 100.0;
    camera.pitch = -0.05 - rng.below(90) / 100.0;
    camera.far = 32'000;  // no fog
    camera.shadow_far = 80;
    View view;
    const auto chunk = [](double v) { return static_cast<std::int32_t>(std::floor(v / 16)); };
    view.centre = {chunk(camera.x), chunk(camera.y), chunk(camera.z)};
    view.radius_h = 3;
    view.radius_v = 2;
    view.levels = 3;
    scene.show(view);
    if (place % 4 == 3) {
      for (int i = 0; i < 12; ++i)
        scene.take_away({view.centre.x + rng.between(-2, 2), view.centre.y + rng.between(-2, 1),
                         view.centre.z + rng.between(-2, 2)});
    }
    const double reach = far_reach(view, 16);
    std::int32_t lowest = 1 << 20;
    for (int x = -26; x <= 26; ++x) {
      for (int z = -26; z <= 26; ++z)
        lowest = std::min(lowest, surface(camera.x + x * 16, camera.z + z * 16));
    }
    FrameContents contents;
    contents.look.quality = place % 2 == 0 ? Quality::low : Quality::high;
    contents.look.time_of_day = 0.5;
    const RenderStats stats = renderer.draw(camera, kPlaceWidth, kPlaceHeight, contents);
    parts_most = std::max(parts_most, stats.tile_parts_drawn);
    const HorizonCount here = count_sky(renderer.read_image(), camera, lowest - 16.0, reach);
    CAPTURE(Catch::rngSeed(), place, camera.x, camera.y, camera.z, camera.yaw, camera.pitch);
    CHECK(here.sky == 0);
    if (here.sky != 0 && std::getenv("RUNSTONE_PICTURES") != nullptr)
      CHECK(write_png(std::string(std::getenv("RUNSTONE_PICTURES")) + "/hole" +
                          std::to_string(place) + ".png",
                      renderer.read_image())
                .has_value());
    total.ground += here.ground;
    total.sky += here.sky;
  }
  CHECK(total.ground > 1'000'000);
  CHECK(parts_most > 20);

  // The oracle is broken on purpose: without the chunks below the eye, the sky is seen through.
  Camera down;
  down.y = world.generator().surface_y(0, 0) + 40;
  down.pitch = -M_PI / 2;
  down.far = 32'000;
  View view;
  view.centre = {0, static_cast<std::int32_t>(down.y / 16), 0};
  view.radius_h = 3;
  view.radius_v = 2;
  view.levels = 3;
  scene.show(view);
  renderer.draw(down, kPlaceWidth, kPlaceHeight);
  CHECK(count_sky(renderer.read_image(), down, -64, 300).sky == 0);
  for (std::uint8_t level = 0; level <= view.levels; ++level) {
    const ChunkCoord at = tile_at(view.centre, level);
    for (std::int32_t x = -1; x <= 1; ++x) {
      for (std::int32_t y = -8; y <= 2; ++y) {
        for (std::int32_t z = -1; z <= 1; ++z)
          renderer.remove({level, {at.x + x, at.y + y, at.z + z}});
      }
    }
  }
  renderer.draw(down, kPlaceWidth, kPlaceHeight);
  CHECK(count_sky(renderer.read_image(), down, -64, 300).sky > 1'000);
}

TEST_CASE("levels fade into each other, and no pixel shows the sky meanwhile", "[render][far]") {
  using MakeContext = std::unique_ptr<GlContext> (*)(std::string&);
  const MakeContext make =
      GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context);
  std::string tried;
  const auto context = make(tried);
  if (!context) {
    WARN("no context: " << tried);
    return;
  }
  FarWorld world(16, red_materials(), "water = \"\"\nbeach = \"\"\n");
  Renderer renderer(context->loader());
  FarScene scene(world, renderer);
  Camera camera;
  camera.y = world.generator().surface_y(0, 0) + 30;
  camera.pitch = -0.9;
  camera.far = 32'000;
  camera.shadow_far = 80;
  View view;
  view.centre = {0, static_cast<std::int32_t>(camera.y / 16), 0};
  view.radius_h = 3;
  view.radius_v = 2;
  view.levels = 3;
  scene.show(view);
  FrameContents contents = noon_with_fades();
  std::uint32_t parts = 0;
  const auto picture_at = [&](double seconds) {
    contents.look.seconds = seconds;
    parts = renderer.draw(camera, kPlaceWidth, kPlaceHeight, contents).chunks_drawn;
    const Image image = renderer.read_image();
    CHECK(count_sky(image, camera, -64, 300).sky == 0);
    return image.rgb;
  };
  const auto different = [](const std::vector<std::uint8_t>& a,
                            const std::vector<std::uint8_t>& b) {
    REQUIRE(a.size() == b.size());
    std::size_t out = 0;
    for (std::size_t at = 0; at < a.size(); at += 3)
      out += std::equal(&a[at], &a[at] + 3, &b[at]) ? 0 : 1;
    return out;
  };
  // The others stay, so that the tiles keep their octants.
  const auto take_half_away = [&] {
    for (std::int32_t x = -3; x <= 3; x += 2) {
      for (std::int32_t y = -3; y <= 2; ++y) {
        for (std::int32_t z = -3; z <= 3; ++z) scene.take_away({x, view.centre.y + y, z});
      }
    }
  };
  for (int frame = 0; frame < 30; ++frame) picture_at(0);  // until light and shadows are complete
  const auto fine = picture_at(0);
  const std::uint32_t parts_fine = parts;
  take_half_away();
  const auto begin = picture_at(10);
  const std::uint32_t parts_begin = parts;
  const auto middle = picture_at(10 + kFadeSeconds / 2);
  const auto coarse = picture_at(11);
  CHECK(parts < parts_begin);  // the chunks are not drawn any more
  CHECK(picture_at(12) == coarse);
  CHECK(different(fine, coarse) > 500);
  CHECK(different(begin, fine) < different(fine, coarse) / 4);  // the light has changed
  CHECK(different(middle, fine) > different(fine, coarse) / 4);
  CHECK(different(middle, coarse) > different(fine, coarse) / 4);

  scene.show(view);  // the chunks come back
  const auto again = picture_at(20);
  CHECK(parts > parts_fine);
  CHECK(different(again, coarse) < different(fine, coarse) / 4);
  const auto half = picture_at(20 + kFadeSeconds / 2);
  CHECK(different(half, fine) < different(again, fine));
  CHECK(different(half, fine) > different(fine, coarse) / 4);
  CHECK(different(picture_at(21), fine) < different(fine, coarse) / 10);
  CHECK(parts == parts_fine);

  // At low quality, tiles do not fade.
  contents.look.quality = Quality::low;
  picture_at(30);
  take_half_away();
  const auto at_once = picture_at(30);
  CHECK(picture_at(31) == at_once);
}

TEST_CASE("transparent faces are blended once while levels fade into each other", "[render][far]") {
  std::string tried;
  const auto context = make_egl_surfaceless_context(tried);
  if (!context) {
    WARN("no context: " << tried);
    return;
  }
  constexpr double kSea =
      120;  // above all ground, and a border of voxels at each level of the view
  // A second face of glass is seen well.
  FarWorld world(16, default_material_table(), "sea_level = 120\nwater = \"glass\"\n");
  Renderer renderer(context->loader());
  FarScene scene(world, renderer);
  Camera camera;
  camera.y = kSea + 20;
  camera.pitch = -1.2;
  camera.far = 32'000;
  View view;
  view.centre = {0, 7, 0};
  view.radius_h = 3;
  view.radius_v = 4;
  view.levels = 2;
  scene.show(view);
  FrameContents contents = noon_with_fades();
  const auto picture_at = [&](double seconds) {
    contents.look.seconds = seconds;
    renderer.draw(camera, kPlaceWidth, kPlaceHeight, contents);
    return renderer.read_image();
  };
  for (int frame = 0; frame < 30; ++frame) picture_at(0);  // until light and shadows are complete
  const Image fine = picture_at(0);
  for (std::int32_t x = -3; x <= 3; x += 2) {
    for (std::int32_t y = 3; y <= 11; ++y) {
      for (std::int32_t z = -3; z <= 3; ++z) scene.take_away({x, y, z});
    }
  }
  picture_at(10);
  const Image middle = picture_at(10 + kFadeSeconds / 2);
  const Image coarse = picture_at(11);
  const auto differs = [&middle](const Image& other, std::size_t pixel) {
    return std::ranges::any_of(std::array{0U, 1U, 2U}, [&](std::size_t c) {
      return std::abs(int{middle.rgb[pixel + c]} - int{other.rgb[pixel + c]}) > 3;
    });
  };
  std::size_t of_fine = 0, of_coarse = 0, of_none = 0;
  for (std::size_t pixel = 0; pixel < middle.rgb.size(); pixel += 3) {
    const bool is_fine = !differs(fine, pixel), is_coarse = !differs(coarse, pixel);
    of_fine += is_fine && !is_coarse ? 1 : 0;
    of_coarse += is_coarse && !is_fine ? 1 : 0;
    of_none += is_fine || is_coarse ? 0 : 1;
  }
  const std::size_t pixels = middle.rgb.size() / 3;
  CAPTURE(pixels, of_fine, of_coarse, of_none);
  // The sides of the bodies take 1.4 %.
  CHECK(of_none < pixels / 50);
}

TEST_CASE("the veil of a server changes no pixel, though octants and stand-ins cut through tiles",
          "[render][far]") {
  std::string tried;
  const auto context = make_egl_surfaceless_context(tried);
  if (!context) {
    WARN("no context: " << tried);
    return;
  }
  struct Pictures {
    std::vector<std::vector<std::uint8_t>> rgb;
    std::size_t tile_bytes = 0;
  };
  const auto pictures_of = [&](TileVeil veil) {
    FarWorld world(16, default_material_table(), "", veil);
    Renderer renderer(context->loader());
    FarScene scene(world, renderer);
    SplitMix64 rng{Catch::rngSeed()};
    Pictures out;
    View view;
    view.radius_h = 3;
    view.radius_v = 2;
    view.levels = 4;
    for (int place = 0; place < 8; ++place) {
      Camera camera;
      camera.x = rng.between(-60, 60) + 0.3;
      camera.z = rng.between(-60, 60) + 0.3;
      camera.y = world.generator().surface_y(static_cast<std::int32_t>(camera.x),
                                             static_cast<std::int32_t>(camera.z)) +
                 3.0 + rng.below(150);
      camera.yaw = rng.below(628) / 100.0;
      camera.pitch = -0.05 - rng.below(60) / 100.0;
      camera.far = 32'000;  // no fog
      camera.shadow_far = 80;
      const auto chunk = [](double v) { return static_cast<std::int32_t>(std::floor(v / 16)); };
      view.centre = {chunk(camera.x), chunk(camera.y), chunk(camera.z)};
      scene.show(view);
      for (int i = 0; i < 12; ++i)
        scene.take_away({view.centre.x + rng.between(-2, 2), view.centre.y + rng.between(-2, 1),
                         view.centre.z + rng.between(-2, 2)});
      FrameContents contents;
      contents.look.time_of_day = 0.5;
      renderer.draw(camera, 640, 400, contents);
      out.rgb.push_back(renderer.read_image().rgb);
    }
    out.tile_bytes = scene.tile_bytes();
    return out;
  };
  const Pictures without = pictures_of(TileVeil::none), with = pictures_of(TileVeil::veiled);
  CAPTURE(Catch::rngSeed());
  CHECK(with.tile_bytes < without.tile_bytes - without.tile_bytes / 20);
  for (std::size_t place = 0; place < without.rgb.size(); ++place) {
    CAPTURE(place);
    CHECK(with.rgb[place] == without.rgb[place]);
  }
}

TEST_CASE("pictures of distant ground", "[.pictures]") {
  const char* const folder = std::getenv("RUNSTONE_PICTURES");
  if (folder == nullptr) {
    WARN("RUNSTONE_PICTURES names no folder");
    return;
  }
  std::string tried;
  const auto context = make_egl_surfaceless_context(tried);
  REQUIRE(context);
  FarWorld world(32, default_material_table(), "");
  Renderer renderer(context->loader());
  FarScene scene(world, renderer);
  View view;
  view.radius_h = 6;
  view.radius_v = 3;
  const char* const levels = std::getenv("RUNSTONE_LEVELS");
  view.levels = static_cast<std::uint8_t>(levels == nullptr ? 3 : std::atoi(levels));
  view.centre = {0, 2, 0};
  scene.show(view);
  WARN(scene.tile_count() << " tiles, " << scene.tile_bytes() << " bytes, " << scene.tile_quads()
                          << " quads, reach " << far_reach(view, 32));
  const auto picture = [&](const std::string& name, double x, double above, double z, double yaw,
                           double pitch, double time, double fog = 1) {
    Camera camera;
    camera.x = x;
    camera.z = z;
    camera.y = above + world.generator().surface_y(static_cast<std::int32_t>(x),
                                                   static_cast<std::int32_t>(z));
    camera.yaw = yaw;
    camera.pitch = pitch;
    camera.far = fog * std::max(far_reach(view, 32), 7.5 * 32);
    camera.shadow_far = 7.5 * 32;
    FrameContents contents;
    contents.look.time_of_day = time;
    const auto start = std::chrono::steady_clock::now();
    const RenderStats stats = renderer.draw(camera, 1280, 720, contents);
    renderer.finish();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    WARN(name << ": " << took.count() << " ms, " << stats.chunks_drawn << " chunks, "
              << stats.tile_parts_drawn << " parts, " << stats.quads_drawn << " quads");
    REQUIRE(
        write_png(std::string(folder) + "/" + name + ".png", renderer.read_image()).has_value());
  };
  picture("ground", 5, 3, 5, 0.6, 0.0, 0.4);
  picture("hill", 5, 40, 5, 2.2, -0.1, 0.4);
  picture("high", 5, 150, 5, 3.9, -0.25, 0.45);
  picture("evening", 5, 60, 5, 5.2, -0.1, 0.72);
  picture("down", 5, 250, 5, 1.0, -0.9, 0.5);
  picture("clear", 5, 120, 5, 0.6, -0.15, 0.4, 10);
}

}  // namespace runstone::test
