#include "client/render/sky_painter.hpp"

#include <glm/gtc/type_ptr.hpp>

#include "client/render/light_glsl.hpp"

namespace runstone {
namespace {

// One triangle covers the screen. The inverse of view and projection gives the direction of each
// pixel.
constexpr const char* kSkyVertexShader =
    "uniform mat4 relative_from_clip;\n"
    "out vec3 direction;\n"
    "void main() {\n"
    "  vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
    "  vec4 far = relative_from_clip * vec4(p, 1.0, 1.0);\n"
    "  direction = far.xyz / far.w;\n"
    "  gl_Position = vec4(p, 1.0, 1.0);\n"
    "}\n";

constexpr const char* kSkyFragmentShader =
    "in vec3 direction;\n"
    "out vec4 fragment;\n" RUNSTONE_LIGHT_GLSL
    "void main() {\n"
    "  vec3 d = normalize(direction);\n"
    "  float disc = smoothstep(0.9990, 0.9995, dot(d, sun_direction));\n"
    "  fragment = vec4(display(sky(d) + glow * (6.0 * disc)), 1.0);\n"
    "}\n";

}  // namespace

SkyPainter::SkyPainter()
    : program_(link_program("sky", kSkyVertexShader, kSkyFragmentShader)),
      array_(GlVertexArray::make()) {}

void SkyPainter::draw(const glm::mat4& clip, const DayLight& light) {
  glUseProgram(program_.get());
  set_light(program_, light);
  const glm::mat4 inverse = glm::inverse(clip);
  glUniformMatrix4fv(glGetUniformLocation(program_.get(), "relative_from_clip"), 1, GL_FALSE,
                     glm::value_ptr(inverse));
  glBindVertexArray(array_.get());
  glDisable(GL_DEPTH_TEST);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

}  // namespace runstone
