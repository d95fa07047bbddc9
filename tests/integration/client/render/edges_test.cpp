// Antialiasing, and drivers that lack it. The cases draw off screen. If there is no OpenGL context,
// they say so with WARN and pass.
#include <string_view>

#include "client/render/antialiasing.hpp"
#include "tests/integration/client/render/different_pixels.hpp"
#include "tests/integration/client/render/ground_scene.hpp"

namespace runstone::test {
namespace {

using VoidFunction = void (*)();

GlContextLoader real_loader = nullptr;

void get_one_sample(GLenum name, GLint* out) {
  if (name == GL_MAX_SAMPLES) {
    *out = 1;
    return;
  }
  reinterpret_cast<PFNGLGETINTEGERVPROC>(real_loader("glGetIntegerv"))(name, out);
}
/// Loads the functions of a driver without MSAA.
VoidFunction load_one_sample(const char* name) {
  if (std::string_view(name) == "glGetIntegerv")
    return reinterpret_cast<VoidFunction>(&get_one_sample);
  return real_loader(name);
}

void store_nothing(GLenum, GLsizei, GLenum, GLsizei, GLsizei) {}
/// Loads the functions of a driver that promises samples and has no storage for them.
VoidFunction load_no_storage(const char* name) {
  if (std::string_view(name) == "glRenderbufferStorageMultisample")
    return reinterpret_cast<VoidFunction>(&store_nothing);
  return real_loader(name);
}

/// A black bar before a white floor, seen from above and turned, so that its edges are jagged.
void lay_bar(GroundScene& scene) {
  scene.set_floor(1);
  scene.set({{12, 4, 2}, {20, 6, 30}}, 2);
  scene.camera.pitch = -M_PI / 2;
  scene.camera.yaw = 0.3;
  scene.camera.y = 22;
  scene.contents.look.time_of_day = 0.5;
  scene.contents.look.quality = Quality::low;
}

MaterialTable black_and_white() {
  MaterialTable out = one_material({255, 255, 255, 255}, {0, 0, 100, 0});
  REQUIRE(out.add({"black",
                   {0, 0, 0, 255},
                   Visibility::opaque,
                   {},
                   MaterialBody::solid,
                   MaterialLook{0, 0, 100, 0}})
              .has_value());
  return out;
}

/// Counts the pixels between black and white.
int count_between(const Image& image) {
  int out = 0;
  for (std::size_t i = 1; i < image.rgb.size(); i += 3)
    out += image.rgb[i] > 75 && image.rgb[i] < 175 ? 1 : 0;
  return out;
}

}  // namespace

TEST_CASE("FXAA and MSAA put colours between those of both sides of an edge", "[render]") {
  GroundScene scene(black_and_white());
  if (!scene.draws()) return;
  lay_bar(scene);
  scene.contents.look.scale = GENERATE(1.0, 0.5);
  const auto picture = [&](Antialiasing antialiasing) {
    scene.contents.look.antialiasing = antialiasing;
    return scene.draw();
  };
  const Image jagged = picture(Antialiasing::off);
  const int between = count_between(jagged);
  for (const auto choice : {Antialiasing::fxaa, Antialiasing::msaa}) {
    const Image smooth = picture(choice);
    CAPTURE(to_string(choice), between, count_between(smooth));
    CHECK(smooth.width == GroundScene::kWidth);
    // A picture that is stretched has colours between others without antialiasing, too.
    if (scene.contents.look.scale == 1) CHECK(count_between(smooth) > between + 60);
    CHECK(different_pixels(jagged, smooth) > 60);
    CHECK(different_pixels(jagged, smooth) < jagged.rgb.size() / 3 / 5);
    CHECK_FALSE(scene.stats.lacks_msaa);
  }
  // The processor draws, so `automatic` is off.
  if (is_software_renderer(reinterpret_cast<const char*>(glGetString(GL_RENDERER))))
    CHECK(different_pixels(jagged, picture(Antialiasing::automatic)) == 0);
  CHECK(different_pixels(jagged, picture(Antialiasing::off)) == 0);
}

TEST_CASE("a driver without MSAA draws FXAA and says so", "[render]") {
  GroundScene scene(black_and_white());
  if (!scene.draws()) return;
  lay_bar(scene);
  scene.contents.look.antialiasing = Antialiasing::fxaa;
  const Image fxaa = scene.draw();
  real_loader = scene.loader();
  for (const GlContextLoader loader : {&load_one_sample, &load_no_storage}) {
    scene.use_loader(loader);
    scene.contents.look.antialiasing = Antialiasing::msaa;
    CHECK(different_pixels(fxaa, scene.draw()) == 0);
    CHECK(scene.stats.lacks_msaa);
    scene.contents.look.antialiasing = Antialiasing::fxaa;
    scene.draw();
    CHECK_FALSE(scene.stats.lacks_msaa);
  }
}

}  // namespace runstone::test
