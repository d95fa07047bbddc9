#include "client/render/glow_painter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "client/render/light_glsl.hpp"

namespace runstone {
namespace {

// A glow is a square that faces the eye, in front of the ball so that it holds all of it.
constexpr const char* kGlowVertexShader =
    "layout(location = 0) in vec3 corner;\n"
    "layout(location = 1) in vec4 ball;\n"  // middle from the eye, and radius
    "layout(location = 2) in vec3 tint;\n"
    "uniform mat4 clip;\n"
    "out vec3 sight;\n"
    "flat out vec4 in_ball;\n"
    "flat out vec3 in_tint;\n"
    "void main() {\n"
    "  sight = corner;\n"
    "  in_ball = ball;\n"
    "  in_tint = tint;\n"
    "  gl_Position = clip * vec4(corner, 1.0);\n"
    "}\n";

// `near` is the least distance of the sight from the middle of the ball, in radii. The distances in
// the depth texture are along the view axis, `axis`.
constexpr const char* kGlowFragmentShader =
    "in vec3 sight;\n"
    "flat in vec4 in_ball;\n"
    "flat in vec3 in_tint;\n"
    "uniform sampler2D scene_depth;\n"
    "uniform vec3 distance_terms, axis;\n"
    "uniform float strength;\n"
    "out vec4 fragment;\n" RUNSTONE_LIGHT_GLSL
    "void main() {\n"
    "  vec3 d = normalize(sight);\n"
    "  float middle = dot(in_ball.xyz, d);\n"
    "  float near2 = dot(in_ball.xyz, in_ball.xyz) - middle * middle;\n"
    "  float inside = 1.0 - near2 / (in_ball.w * in_ball.w);\n"
    "  if (inside <= 0.0) discard;\n"
    "  float half_way = in_ball.w * sqrt(inside);\n"
    "  float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).x;\n"
    "  float ground = distance_terms.x / (distance_terms.y * depth + distance_terms.z);\n"
    "  ground /= max(dot(d, axis), 0.05);\n"
    "  float seen = clamp((ground - middle + half_way) / (2.0 * half_way), 0.0, 1.0);\n"
    "  float clear = 1.0 - fog_share(in_ball.xyz, length(in_ball.xyz));\n"
    "  fragment = vec4(in_tint * (strength * seen * clear * inside * inside * inside), 1.0);\n"
    "}\n";

constexpr std::size_t kFloats = 10;  // of a vertex

}  // namespace

GlowPainter::GlowPainter()
    : program_(link_program("glow", kGlowVertexShader, kGlowFragmentShader)),
      array_(GlVertexArray::make()),
      vertices_(GlBuffer::make()) {
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  const auto attribute = [](GLuint number, GLint count, std::size_t first) {
    glEnableVertexAttribArray(number);
    glVertexAttribPointer(number, count, GL_FLOAT, GL_FALSE, kFloats * sizeof(float),
                          reinterpret_cast<const void*>(first * sizeof(float)));
  };
  attribute(0, 3, 0);
  attribute(1, 4, 3);
  attribute(2, 3, 7);
  glBindVertexArray(0);
}

void GlowPainter::draw(std::span<const GlowInView> glows, const glm::mat4& clip,
                       const DepthRange& depth, const DayLight& light, GLuint scene_depth) {
  staged_.clear();
  for (const GlowInView& glow : glows.first(std::min(glows.size(), kGlowsMax))) {
    const float distance = glm::length(glow.at);
    // The eye does not see the ball that it is in.
    const float outside = std::clamp(distance / glow.radius - 1.0F, 0.0F, 1.0F);
    if (outside <= 0) continue;
    const glm::vec3 to = glow.at / distance;
    const glm::vec3 up = std::abs(to.y) > 0.99F ? glm::vec3{1, 0, 0} : glm::vec3{0, 1, 0};
    const glm::vec3 right = glm::normalize(glm::cross(to, up));
    const glm::vec3 top = glm::cross(right, to);
    // The cone around the ball, at the distance of the square.
    const float front = distance - 0.5F * glow.radius;
    const float half =
        front * glow.radius / std::sqrt(distance * distance - glow.radius * glow.radius);
    // Display colours are about the square root of linear ones.
    const glm::vec3 tint = outside * glm::sqrt(glow.colour);
    constexpr std::array<std::array<float, 2>, 6> kCorners = {
        {{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}};
    for (const auto& [u, v] : kCorners) {
      const glm::vec3 corner = to * front + (right * u + top * v) * half;
      for (const float value : {corner.x, corner.y, corner.z, glow.at.x, glow.at.y, glow.at.z,
                                glow.radius, tint.r, tint.g, tint.b}) {
        staged_.push_back(value);
      }
    }
  }
  if (staged_.empty()) return;
  glUseProgram(program_.get());
  set_light(program_, light);
  const auto at = [this](const char* name) { return glGetUniformLocation(program_.get(), name); };
  glUniformMatrix4fv(at("clip"), 1, GL_FALSE, glm::value_ptr(clip));
  const glm::vec3 terms = depth.distance_terms();
  glUniform3fv(at("distance_terms"), 1, glm::value_ptr(terms));
  // The last row of a projection gives the distance along the view axis.
  const glm::vec3 axis = glm::normalize(glm::vec3{clip[0][3], clip[1][3], clip[2][3]});
  glUniform3fv(at("axis"), 1, glm::value_ptr(axis));
  // In daylight a glow is faint.
  glUniform1f(at("strength"), 0.18F + 0.42F * light.night);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, scene_depth);
  glUniform1i(at("scene_depth"), 0);
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(staged_.size() * sizeof(float)),
               staged_.data(), GL_STREAM_DRAW);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  // Light adds up to white, and no further.
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_COLOR);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(staged_.size() / kFloats));
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
}

}  // namespace runstone
