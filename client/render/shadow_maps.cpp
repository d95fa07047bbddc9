#include "client/render/shadow_maps.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <stdexcept>

namespace runstone {
namespace {

/// A cascade reaches this much farther than its radius, and its middle is a multiple of this part
/// of the radius, so that the eye can move before it is drawn again.
constexpr double kStep = 0.25;
/// Terrain towards the sun casts shadows from this far outside a cascade, in radii of the largest.
constexpr double kDepth = 1.6;

}  // namespace

ShadowMaps::ShadowMaps() : maps_(GlTexture::make()) {
  for (Cascade& cascade : cascades_) {
    for (GlFramebuffer& framebuffer : cascade.framebuffers) framebuffer = GlFramebuffer::make();
  }
}

void ShadowMaps::set_quality(Quality quality) {
  const bool is_high = quality == Quality::high;
  resize(is_high ? 2048 : 1024);
  // The comparison of four pixels is interpolated if the filter is linear.
  const GLint filter = is_high ? GL_LINEAR : GL_NEAREST;
  glBindTexture(GL_TEXTURE_2D_ARRAY, maps_.get());
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, filter);
}

void ShadowMaps::resize(int side) {
  if (side == side_) return;
  side_ = side;
  glBindTexture(GL_TEXTURE_2D_ARRAY, maps_.get());
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT16, side, side, 2 * kCascades, 0,
               GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, nullptr);
  const auto set = [](GLenum what, GLint value) {
    glTexParameteri(GL_TEXTURE_2D_ARRAY, what, value);
  };
  set(GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  set(GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  set(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  set(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  GLint layer = 0;
  for (Cascade& cascade : cascades_) {
    cascade.is_drawn = false;
    cascade.next.reset();
    for (const GlFramebuffer& framebuffer : cascade.framebuffers) {
      glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
      glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, maps_.get(), 0, layer++);
      constexpr GLenum kNone = GL_NONE;
      glDrawBuffers(1, &kNone);
      glReadBuffer(GL_NONE);
      if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("the OpenGL driver cannot draw shadow maps");
    }
  }
}

void ShadowMaps::set_radii(double near, double far) {
  const std::array<double, kCascades> radii = {near, std::max(far, 2 * near)};
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (cascades_[i].radius == radii[i]) continue;
    cascades_[i].radius = radii[i];
    cascades_[i].is_drawn = false;
    cascades_[i].next.reset();
  }
}

void ShadowMaps::changed(const glm::dvec3& min, const glm::dvec3& max) {
  const glm::dvec3 middle = 0.5 * (min + max);
  const double reach = 0.5 * glm::length(max - min);
  for (Cascade& cascade : cascades_) {
    if (is_touched(cascade, cascade.middle, middle, reach) ||
        (cascade.next && is_touched(cascade, cascade.next->middle, middle, reach)))
      cascade.is_stale = true;
  }
}

bool ShadowMaps::is_touched(const Cascade& cascade, const glm::dvec3& middle,
                            const glm::dvec3& change, double reach) const {
  // Only the distance from the axis of the light through the cascade counts.
  const glm::dvec3 at = to_light_ * (change - middle);
  const double side = cascade.radius * (1 + kStep) * std::sqrt(2.0) + reach;
  return at.x * at.x + at.y * at.y <= side * side;
}

glm::dvec3 ShadowMaps::middle_of(const Cascade& cascade, const glm::dvec3& eye) const {
  // The grid of middles is fixed to the world and seen from the light. Its step is a whole number
  // of pixels, so each pixel covers the same place before and after.
  const double reach = cascade.radius * (1 + kStep);
  const double pixel = 2 * reach / side_;
  const double step = std::max(1.0, std::floor(cascade.radius * kStep / pixel)) * pixel;
  glm::dvec3 at = to_light_ * eye;
  for (int i = 0; i < 3; ++i) at[i] = std::round(at[i] / step) * step;
  return glm::transpose(to_light_) * at;
}

void ShadowMaps::update(const glm::dvec3& eye, const DayLight& light, double near, double far,
                        Quality quality, bool all, const DrawTerrain& draw_terrain) {
  set_quality(quality);
  set_radii(near, far);
  if (light.sun_direction != sun_) {
    sun_ = light.sun_direction;
    const glm::dvec3 back(sun_);
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3{0, 1, 0}, back));
    to_light_ = glm::transpose(glm::dmat3(right, glm::cross(back, right), back));
    for (Cascade& cascade : cascades_) cascade.is_drawn = false;
  }
  for (Cascade& cascade : cascades_) {
    const glm::dvec3 middle = middle_of(cascade, eye);
    const bool is_near = cascade.is_drawn && glm::length(middle - cascade.middle) < cascade.radius;
    const bool is_wanted = !is_near || cascade.is_stale || middle != cascade.middle;
    if (all || !is_near) {
      if (!is_wanted && !cascade.next) continue;
      begin(cascade, middle);
      step(cascade, std::numeric_limits<std::size_t>::max(), draw_terrain);
    } else {
      if (is_wanted && !cascade.next) begin(cascade, middle);
      if (cascade.next) step(cascade, kQuadsAFrame, draw_terrain);
    }
  }
}

void ShadowMaps::begin(Cascade& cascade, const glm::dvec3& middle) {
  cascade.is_stale = false;
  const auto reach = static_cast<float>(cascade.radius * (1 + kStep));
  const auto depth = static_cast<float>(cascades_.back().radius * kDepth);
  const glm::mat4 view(glm::dmat4{to_light_});
  cascade.next = ShadowPass{glm::ortho(-reach, reach, -reach, reach, -depth, depth) * view, middle,
                            2 * reach / static_cast<float>(side_)};
}

void ShadowMaps::step(Cascade& cascade, std::size_t quads_max, const DrawTerrain& draw_terrain) {
  const int layer = cascade.shown ^ 1;
  glBindFramebuffer(GL_FRAMEBUFFER, cascade.framebuffers[static_cast<std::size_t>(layer)].get());
  glViewport(0, 0, side_, side_);
  if (!cascade.next->drawn_to) glClear(GL_DEPTH_BUFFER_BIT);
  if (!draw_terrain(*cascade.next, quads_max)) return;
  cascade.middle = cascade.next->middle;
  cascade.shown = layer;
  cascade.is_drawn = true;
  cascade.next.reset();
}

void ShadowMaps::bind(const GlProgram& program, GLint unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D_ARRAY, maps_.get());
  const glm::mat3 turn(to_light_);
  glUniform1i(glGetUniformLocation(program.get(), "shadow_maps"), unit);
  glUniformMatrix3fv(glGetUniformLocation(program.get(), "to_light"), 1, GL_FALSE,
                     glm::value_ptr(turn));
}

int ShadowMaps::cascade_of(const glm::dvec3& middle, double radius) const {
  const Cascade& inner = cascades_.front();
  const glm::dvec3 at = to_light_ * (middle - inner.middle);
  const double reach = inner.radius * (1 + kStep) - radius;
  return std::abs(at.x) < reach && std::abs(at.y) < reach ? 0 : 1;
}

void ShadowMaps::use(const GlProgram& program, int cascade, const glm::dvec3& eye) const {
  const Cascade& c = cascades_[static_cast<std::size_t>(cascade)];
  const double reach = c.radius * (1 + kStep);
  const double depth = cascades_.back().radius * kDepth;
  // From turned coordinates to 0 .. 1 in the map, in depth too. The light looks along its negative
  // third axis.
  const glm::dvec3 to_unit = 0.5 / glm::dvec3{reach, reach, -depth};
  const glm::dvec3 eye_from_middle = to_light_ * (eye - c.middle);
  const glm::vec3 scale(to_unit);
  const glm::vec3 offset(eye_from_middle * to_unit + 0.5);
  const auto at = [&program](const char* name) {
    return glGetUniformLocation(program.get(), name);
  };
  glUniform3fv(at("shadow_scale"), 1, glm::value_ptr(scale));
  glUniform3fv(at("shadow_offset"), 1, glm::value_ptr(offset));
  glUniform1f(at("shadow_bias"), static_cast<float>(1.5 * 2 * reach / side_));
  glUniform1i(at("shadow_layer"), 2 * cascade + c.shown);
}

std::uint64_t ShadowMaps::byte_size() const {
  return std::uint64_t{2} * 2 * kCascades * static_cast<std::uint64_t>(side_) *
         static_cast<std::uint64_t>(side_);
}

}  // namespace runstone
