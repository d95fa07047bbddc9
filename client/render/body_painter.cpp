#include "client/render/body_painter.hpp"

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "client/render/light_glsl.hpp"

namespace runstone {
namespace {

/// The vertex number gives the corner: six faces of two triangles.
constexpr const char* kBodyVertexShader =
    "uniform mat4 clip;\n"
    "uniform mat4 model;\n"  // eye-relative space from the unit cube
    "out vec3 relative;\n"
    "flat out vec3 normal;\n"
    "void main() {\n"
    "  int face = gl_VertexID / 6;\n"
    "  int corner = gl_VertexID % 6;\n"
    "  int axis = face >> 1;\n"
    "  bool positive = (face & 1) != 0;\n"
    "  float a = (corner == 1 || corner == 2 || corner == 4) ? 1.0 : 0.0;\n"
    "  float b = (corner == 2 || corner == 4 || corner == 5) ? 1.0 : 0.0;\n"
    "  if (!positive) a = 1.0 - a;\n"
    "  vec3 p = vec3(0.0), n = vec3(0.0);\n"
    "  p[axis] = positive ? 1.0 : 0.0;\n"
    "  p[(axis + 1) % 3] = a;\n"
    "  p[(axis + 2) % 3] = b;\n"
    "  n[axis] = positive ? 1.0 : -1.0;\n"
    "  vec4 at = model * vec4(p, 1.0);\n"
    "  relative = at.xyz;\n"
    "  normal = normalize(mat3(model) * n);\n"
    "  gl_Position = clip * at;\n"
    "}\n";

constexpr const char* kBodyFragmentShader =
    "in vec3 relative;\n"
    "flat in vec3 normal;\n"
    "uniform vec3 colour;\n"  // linear
    "uniform vec4 around;\n"  // light at the body
    "out vec4 fragment;\n" RUNSTONE_LIGHT_GLSL
    "void main() {\n"
    "  float sun = max(dot(normal, sun_direction), 0.0);\n"
    "  vec3 lit = colour * (sun_colour * (sun * around.a) + field_lit(around, normal));\n"
    "  fragment = vec4(display(in_fog(lit, relative)), 1.0);\n"
    "}\n";

/// A part of a body: a box around the vertical axis of the player, who looks along +z. The unit is
/// a voxel.
struct Part {
  glm::vec3 min, size;
  float shade;  // factor of the player's colour
  bool is_head;
};

constexpr float kNeck = 1.36F;
const std::array<Part, 6> kParts = {{
    {{-0.20F, 0.00F, -0.10F}, {0.18F, 0.66F, 0.20F}, 0.35F, false},
    {{0.02F, 0.00F, -0.10F}, {0.18F, 0.66F, 0.20F}, 0.35F, false},
    {{-0.22F, 0.66F, -0.13F}, {0.44F, 0.68F, 0.26F}, 1.0F, false},
    {{-0.37F, 0.70F, -0.09F}, {0.14F, 0.62F, 0.18F}, 0.75F, false},
    {{0.23F, 0.70F, -0.09F}, {0.14F, 0.62F, 0.18F}, 0.75F, false},
    {{-0.22F, 0.00F, -0.22F}, {0.44F, 0.44F, 0.44F}, 1.2F, true},
}};
/// The eyes lie on the front of the head, so that the direction of sight is seen.
const std::array<Part, 2> kEyes = {{
    {{-0.15F, 0.20F, 0.20F}, {0.09F, 0.09F, 0.03F}, 0.0F, true},
    {{0.06F, 0.20F, 0.20F}, {0.09F, 0.09F, 0.03F}, 0.0F, true},
}};

float linear(std::uint8_t v) { return std::pow(static_cast<float>(v) / 255.0F, 2.2F); }

glm::mat4 box_of(const glm::mat4& frame, const Part& part) {
  return glm::scale(glm::translate(frame, part.min), part.size);
}

}  // namespace

BodyPainter::BodyPainter()
    : program_(link_program("body", kBodyVertexShader, kBodyFragmentShader)),
      array_(GlVertexArray::make()) {}

void BodyPainter::draw(std::span<const Body> bodies, const glm::dvec3& eye, const glm::mat4& clip,
                       const DayLight& light, const LightAt& light_at) {
  if (bodies.empty()) return;
  constexpr int kVertices = 36;
  glUseProgram(program_.get());
  set_light(program_, light);
  glUniformMatrix4fv(glGetUniformLocation(program_.get(), "clip"), 1, GL_FALSE,
                     glm::value_ptr(clip));
  const GLint model = glGetUniformLocation(program_.get(), "model");
  const GLint colour = glGetUniformLocation(program_.get(), "colour");
  const GLint around = glGetUniformLocation(program_.get(), "around");
  glBindVertexArray(array_.get());
  for (const Body& body : bodies) {
    const glm::vec3 feet(glm::dvec3{body.x, body.y, body.z} - eye);
    const glm::vec3 own{linear(body.r), linear(body.g), linear(body.b)};
    const glm::mat4 stand = glm::rotate(glm::translate(glm::mat4(1), feet),
                                        static_cast<float>(body.yaw), glm::vec3{0, 1, 0});
    const glm::mat4 head = glm::rotate(glm::translate(stand, glm::vec3{0, kNeck, 0}),
                                       -static_cast<float>(body.pitch), glm::vec3{1, 0, 0});
    constexpr double kChest = 1.1;
    const glm::vec4 at_body = light_at({body.x, body.y + kChest, body.z});
    glUniform4fv(around, 1, glm::value_ptr(at_body));
    const auto draw_part = [&](const Part& part) {
      const glm::mat4 box = box_of(part.is_head ? head : stand, part);
      const glm::vec3 of_part = own * part.shade;
      glUniformMatrix4fv(model, 1, GL_FALSE, glm::value_ptr(box));
      glUniform3fv(colour, 1, glm::value_ptr(of_part));
      glDrawArrays(GL_TRIANGLES, 0, kVertices);
    };
    for (const Part& part : kParts) draw_part(part);
    for (const Part& part : kEyes) draw_part(part);
  }
}

}  // namespace runstone
