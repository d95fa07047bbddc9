#include "client/render/sky_painter.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <string>

#include "client/render/light_glsl.hpp"
#include "client/render/sky_glsl.hpp"

namespace runstone {
namespace {

/// The texture of the clouds covers this many voxels. They are at this height, or this far above an
/// eye that is higher, and drift along x.
constexpr double kCloudPeriod = 4'096, kCloudHeight = 320, kCloudsAboveEye = 140;
constexpr double kDriftASecond = 0.8;  // voxels

// One triangle covers the screen, at the far plane. The inverse of view and projection gives the
// direction of each pixel.
constexpr const char* kSkyVertexShader =
    "uniform mat4 relative_from_clip;\n"
    "uniform float far_plane;\n"
    "out vec3 direction;\n"
    "void main() {\n"
    "  vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
    "  vec4 far = relative_from_clip * vec4(p, 1.0, 1.0);\n"
    "  direction = far.xyz / far.w;\n"
    "  gl_Position = vec4(p, far_plane, 1.0);\n"
    "}\n";

constexpr const char* kSkyFragmentShader =
    "in vec3 direction;\n"
    "out vec4 fragment;\n"
    "uniform sampler2D noise;\n" RUNSTONE_LIGHT_GLSL RUNSTONE_DISC_GLSL
        RUNSTONE_STARS_GLSL RUNSTONE_CLOUDS_GLSL
    "void main() {\n"
    "  vec3 d = normalize(direction);\n"
    "  vec3 c = sky(d);\n"
    "#ifdef RUNSTONE_CLOUDS\n"
    "  vec4 cloud = clouds(d);\n"
    "#else\n"
    "  const vec4 cloud = vec4(0.0);\n"
    "#endif\n"
    "#ifdef RUNSTONE_STARS\n"
    "  c += starlight(d) * (stars * (1.0 - cloud.a) * smoothstep(0.0, 0.20, d.y));\n"
    "#endif\n"
    "  c = mix(with_disc(c, d), cloud.rgb, cloud.a);\n"
    "  fragment = vec4(display(c), 1.0);\n"
    "}\n";

}  // namespace

glm::vec3 cloud_place(const glm::dvec3& eye, double seconds) {
  const double way = std::max(kCloudHeight - eye.y, kCloudsAboveEye);
  const auto share = [](double voxels) {
    const double turns = voxels / kCloudPeriod;
    return turns - std::floor(turns);
  };
  return glm::vec3(
      glm::dvec3{share(eye.x + kDriftASecond * seconds), share(eye.z), way / kCloudPeriod});
}

SkyPainter::SkyPainter() : array_(GlVertexArray::make()) {}

GlProgram& SkyPainter::program(bool has_stars, bool is_moon, bool has_clouds) {
  GlProgram& out = programs_[(has_stars ? 1U : 0U) + (is_moon ? 2U : 0U) + (has_clouds ? 4U : 0U)];
  if (!out) {
    std::string text;
    if (has_stars) text += "#define RUNSTONE_STARS\n";
    if (is_moon) text += "#define RUNSTONE_MOON\n";
    if (has_clouds) text += "#define RUNSTONE_CLOUDS\n";
    out = link_program("sky", kSkyVertexShader, (text + kSkyFragmentShader).c_str());
  }
  return out;
}

void SkyPainter::draw(const SkyView& view, const DepthRange& depth, const DayLight& light,
                      const NoiseTexture& noise) {
  const bool has_clouds = view.has_clouds && light.has_clouds;
  const GlProgram& program = this->program(light.stars > 0, light.is_moon, has_clouds);
  glUseProgram(program.get());
  set_light(program, light);
  const auto at = [&](const char* name) { return glGetUniformLocation(program.get(), name); };
  const glm::mat4 inverse = glm::inverse(view.clip);
  glUniformMatrix4fv(at("relative_from_clip"), 1, GL_FALSE, glm::value_ptr(inverse));
  glUniform1f(at("far_plane"), depth.is_reversed() ? 0.0F : 1.0F);
  glUniform1f(at("stars"), light.stars);
  glUniform1f(at("pixel"), static_cast<float>(view.pixel));
  // Back to the sky of midnight.
  glUniform2f(at("star_turn"), std::cos(light.star_angle), -std::sin(light.star_angle));
  glUniform1f(at("cloud_cover"), light.has_clouds ? 1.0F : 0.0F);
  glUniform3fv(at("cloud_lit"), 1, glm::value_ptr(light.cloud_lit));
  glUniform3fv(at("cloud_shade"), 1, glm::value_ptr(light.cloud_shade));
  const glm::vec3 place = cloud_place(view.eye, view.seconds);
  glUniform3fv(at("cloud_place"), 1, glm::value_ptr(place));
  noise.bind(program, 0);
  glBindVertexArray(array_.get());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(depth.not_farther());
  glDepthMask(GL_FALSE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
  glDepthFunc(depth.nearer());
}

}  // namespace runstone
