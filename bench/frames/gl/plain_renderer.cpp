#include "bench/frames/gl/plain_renderer.hpp"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "bench/frames/gl/orbit.hpp"
#include "bench/frames/gl/plain_shaders.hpp"

namespace runstone::bench {
namespace {

/// Returns GL_SAMPLES_PASSED of what `draw` draws.
template <class Draw>
std::uint64_t samples_of(Draw&& draw) {
  GLuint query = 0;
  glGenQueries(1, &query);
  glBeginQuery(GL_SAMPLES_PASSED, query);
  draw();
  glEndQuery(GL_SAMPLES_PASSED);
  GLuint64 samples = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &samples);
  glDeleteQueries(1, &query);
  return samples;
}

}  // namespace

PlainRenderer::PlainRenderer(GlContextLoader loader, int width, int height)
    : width_(width), height_(height) {
  load_gl(loader);
  colour_.indexed = link_program("plain", kPlainVertexShader, kPlainFragmentShader);
  colour_.packed = link_program("plain packed", kPackedVertexShader, kPlainFragmentShader);
  target_.bind(width, height);
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 45) return;
  lanes_.indexed = link_program("lanes", kPlainVertexShader, kLanesFragmentShader);
  lanes_.packed = link_program("lanes packed", kPackedVertexShader, kLanesFragmentShader);
  lanes_colour_ = GlRenderbuffer::make();
  glBindRenderbuffer(GL_RENDERBUFFER, lanes_colour_.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_R32F, width, height);
  lanes_depth_ = GlRenderbuffer::make();
  glBindRenderbuffer(GL_RENDERBUFFER, lanes_depth_.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
  lanes_framebuffer_ = GlFramebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, lanes_framebuffer_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                            lanes_colour_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                            lanes_depth_.get());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("the driver refuses an off-screen target of floats");
  }
}

void PlainRenderer::bind(bool depth_test) {
  target_.bind(width_, height_);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  depth_test ? glEnable(GL_DEPTH_TEST) : glDisable(GL_DEPTH_TEST);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void PlainRenderer::draw_with(const Programs& programs, const PlainScene& scene,
                              const Camera& camera) {
  struct Visible {
    const PlainScene::Chunk* chunk;
    float distance2;
  };
  const glm::vec3 eye{static_cast<float>(camera.x), static_cast<float>(camera.y),
                      static_cast<float>(camera.z)};
  std::vector<Visible> visible;
  for (const PlainScene::Chunk& chunk : scene.chunks_) {
    const glm::vec3 away = chunk.centre - eye;
    visible.push_back({&chunk, glm::dot(away, away)});
  }
  std::sort(visible.begin(), visible.end(), [](const Visible& a, const Visible& b) {
    return std::tie(a.distance2, a.chunk) < std::tie(b.distance2, b.chunk);
  });
  const GlProgram& program = scene.packed_ ? programs.packed : programs.indexed;
  glUseProgram(program.get());
  glUniformMatrix4fv(glGetUniformLocation(program.get(), "clip"), 1, GL_FALSE,
                     glm::value_ptr(clip_of(camera, width_, height_)));
  const GLint origin = glGetUniformLocation(program.get(), "origin");
  for (const Visible& v : visible) {
    glUniform3fv(origin, 1, glm::value_ptr(v.chunk->origin));
    glBindVertexArray(v.chunk->array.get());
    if (scene.packed_) {
      glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, v.chunk->count);
    } else {
      glDrawElements(GL_TRIANGLES, v.chunk->count, GL_UNSIGNED_INT, nullptr);
    }
  }
}

void PlainRenderer::draw(const PlainScene& scene, const Camera& camera) {
  bind(true);
  draw_with(colour_, scene, camera);
}

DrawnPicture PlainRenderer::read() {
  DrawnPicture out{width_, height_, {}};
  out.pixels.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target_.framebuffer());
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, out.pixels.data());
  return out;
}

std::uint64_t PlainRenderer::fragments_drawn(const PlainScene& scene, const Camera& camera) {
  bind(true);
  return samples_of([&] { draw_with(colour_, scene, camera); });
}

std::uint64_t PlainRenderer::fragments_covered(const PlainScene& scene, const Camera& camera) {
  bind(false);
  return samples_of([&] { draw_with(colour_, scene, camera); });
}

std::optional<double> PlainRenderer::lanes_shaded(const PlainScene& scene, const Camera& camera) {
  if (!lanes_.indexed) return std::nullopt;
  bind(true);
  glBindFramebuffer(GL_FRAMEBUFFER, lanes_framebuffer_.get());
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  draw_with(lanes_, scene, camera);
  glDisable(GL_BLEND);
  std::vector<float> lanes(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  glReadPixels(0, 0, width_, height_, GL_RED, GL_FLOAT, lanes.data());
  double sum = 0;
  for (const float pixel : lanes) sum += static_cast<double>(pixel);
  return sum;
}

}  // namespace runstone::bench
