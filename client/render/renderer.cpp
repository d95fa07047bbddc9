#include "client/render/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <stdexcept>

#include "client/render/chunk_buffers.hpp"
#include "client/render/frame_target.hpp"
#include "client/render/frustum.hpp"
#include "client/render/gl_handle.hpp"
#include "client/render/shaders.hpp"

namespace runstone {
namespace {

/// The corners of the unit cube as the ends of 12 edges and as 12 triangles. Bits 0, 1, 2 of a
/// corner are x, y, z.
constexpr int kEdgeVertices = 24;
constexpr int kCubeVertices = 36;
constexpr std::array<std::uint8_t, kEdgeVertices> kEdges = {0, 1, 1, 3, 3, 2, 2, 0, 4, 5, 5, 7,
                                                            7, 6, 6, 4, 0, 4, 1, 5, 2, 6, 3, 7};
constexpr std::array<std::uint8_t, kCubeVertices> kFaces = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5,
                                                            0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3,
                                                            0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};

/// One chunk in view, with its origin relative to the eye.
struct Visible {
  const ChunkBuffers* buffers;
  glm::vec3 origin, pattern;
  float distance2;
};

float linear_from_srgb(std::uint8_t v) { return std::pow(static_cast<float>(v) / 255.0F, 2.2F); }

}  // namespace

struct Renderer::State {
  explicit State(GlContextLoader loader) {
    if (gladLoadGL(loader) == 0) throw std::runtime_error("the OpenGL loader found no functions");
    quad_program = link_program("quad", kQuadVertexShader, kQuadFragmentShader);
    sky_program = link_program("sky", kSkyVertexShader, kSkyFragmentShader);
    marker_program = link_program("marker", kMarkerVertexShader, kMarkerFragmentShader);
    empty_array = GlVertexArray::make();
    palette = GlTexture::make();
    marker_array = GlVertexArray::make();
    marker_buffer = GlBuffer::make();
    fill_marker_buffer();
    set_materials(MaterialTable{});
  }

  void fill_marker_buffer() {
    std::vector<float> corners;
    const auto add = [&](std::uint8_t c) {
      corners.insert(corners.end(), {static_cast<float>(c & 1), static_cast<float>(c >> 1 & 1),
                                     static_cast<float>(c >> 2)});
    };
    std::for_each(kEdges.begin(), kEdges.end(), add);
    std::for_each(kFaces.begin(), kFaces.end(), add);
    glBindVertexArray(marker_array.get());
    glBindBuffer(GL_ARRAY_BUFFER, marker_buffer.get());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(float)),
                 corners.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  }

  void set_materials(const MaterialTable& materials) {
    // Light is added in linear space, so the palette is stored in linear space. 16-bit floats keep
    // dark colours smooth.
    std::vector<float> texels(std::size_t{256} * 256 * 4, 1.0F);
    for (std::size_t id = 0; id < materials.size(); ++id) {
      const auto& colour = materials[static_cast<Material>(id)].colour;
      for (std::size_t c = 0; c < 3; ++c) texels[id * 4 + c] = linear_from_srgb(colour[c]);
      texels[id * 4 + 3] = static_cast<float>(colour[3]) / 255.0F;
    }
    glBindTexture(GL_TEXTURE_2D, palette.get());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, 256, 256, 0, GL_RGBA, GL_FLOAT, texels.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }

  void draw_sky(const glm::mat4& clip) {
    glUseProgram(sky_program.get());
    const glm::mat4 inverse = glm::inverse(clip);
    set_matrix(sky_program, "relative_from_clip", inverse);
    glBindVertexArray(empty_array.get());
    glDisable(GL_DEPTH_TEST);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
  }

  std::vector<Visible> visible_chunks(const Camera& camera, const Frustum& frustum,
                                      RenderStats& stats) const {
    std::vector<Visible> out;
    for (const auto& [key, buffers] : chunks) {
      const VoxelPos o = origin_of(key.at, buffers.edge());
      const glm::vec3 origin{static_cast<float>(o.x - camera.x), static_cast<float>(o.y - camera.y),
                             static_cast<float>(o.z - camera.z)};
      const auto edge = static_cast<float>(buffers.edge());
      if (!frustum.may_see(origin, origin + edge)) {
        ++stats.chunks_culled;
        continue;
      }
      const glm::vec3 pattern{static_cast<float>(o.x & 4095), static_cast<float>(o.y & 4095),
                              static_cast<float>(o.z & 4095)};
      const glm::vec3 centre = origin + 0.5F * edge;
      out.push_back({&buffers, origin, pattern, glm::dot(centre, centre)});
    }
    std::sort(out.begin(), out.end(),
              [](const Visible& a, const Visible& b) { return a.distance2 < b.distance2; });
    return out;
  }

  void place(const Visible& v) const {
    glUniform3fv(glGetUniformLocation(quad_program.get(), "origin"), 1, glm::value_ptr(v.origin));
    glUniform3fv(glGetUniformLocation(quad_program.get(), "pattern"), 1, glm::value_ptr(v.pattern));
  }

  void draw_chunks(const Camera& camera, const glm::mat4& clip, RenderStats& stats) {
    const std::vector<Visible> visible = visible_chunks(camera, Frustum(clip), stats);
    glUseProgram(quad_program.get());
    set_matrix(quad_program, "clip", clip);
    const auto fog_end = static_cast<float>(camera.far);
    glUniform1f(glGetUniformLocation(quad_program.get(), "fog_start"), fog_end * 0.6F);
    glUniform1f(glGetUniformLocation(quad_program.get(), "fog_end"), fog_end * 0.98F);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, palette.get());
    glUniform1i(glGetUniformLocation(quad_program.get(), "palette"), 0);
    glEnable(GL_CULL_FACE);
    glUniform1f(glGetUniformLocation(quad_program.get(), "seam"), 0.0002F);
    // Chunks are drawn from near to far, so that hidden pixels fail the depth test early.
    for (const Visible& v : visible) {
      place(v);
      v.buffers->draw_opaque();
      stats.quads_drawn += v.buffers->opaque_count() + v.buffers->transparent_count();
    }
    stats.chunks_drawn = static_cast<std::uint32_t>(visible.size());
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glDisable(GL_CULL_FACE);  // water is also seen from below
    // Quads that overlap would be blended twice.
    glUniform1f(glGetUniformLocation(quad_program.get(), "seam"), 0.0F);
    for (auto v = visible.rbegin(); v != visible.rend(); ++v) {
      if (v->buffers->transparent_count() == 0) continue;
      place(*v);
      v->buffers->draw_transparent();
    }
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
  }

  void draw_markers(const Camera& camera, const glm::mat4& clip, std::span<const Marker> markers) {
    if (markers.empty()) return;
    glUseProgram(marker_program.get());
    set_matrix(marker_program, "clip", clip);
    glBindVertexArray(marker_array.get());
    for (const Marker& m : markers) {
      // An outline is a little larger than its voxel. Otherwise the depth test would hide parts of
      // it.
      const double grow = m.filled ? 0.0 : 0.01;
      glUniform3f(glGetUniformLocation(marker_program.get(), "origin"),
                  static_cast<float>(m.x - grow - camera.x),
                  static_cast<float>(m.y - grow - camera.y),
                  static_cast<float>(m.z - grow - camera.z));
      glUniform3f(glGetUniformLocation(marker_program.get(), "size"),
                  static_cast<float>(m.size_x + 2 * grow), static_cast<float>(m.size_y + 2 * grow),
                  static_cast<float>(m.size_z + 2 * grow));
      glUniform4f(glGetUniformLocation(marker_program.get(), "colour"),
                  static_cast<float>(m.r) / 255.0F, static_cast<float>(m.g) / 255.0F,
                  static_cast<float>(m.b) / 255.0F, 1.0F);
      if (m.filled) {
        glDrawArrays(GL_TRIANGLES, kEdgeVertices, kCubeVertices);
      } else {
        glDrawArrays(GL_LINES, 0, kEdgeVertices);
      }
    }
  }

  static void set_matrix(const GlProgram& program, const char* name, const glm::mat4& matrix) {
    glUniformMatrix4fv(glGetUniformLocation(program.get(), name), 1, GL_FALSE,
                       glm::value_ptr(matrix));
  }

  GlProgram quad_program, sky_program, marker_program;
  GlVertexArray empty_array, marker_array;
  GlBuffer marker_buffer;
  GlTexture palette;
  FrameTarget target;
  std::map<ChunkKey, ChunkBuffers> chunks;
};

Renderer::Renderer(GlContextLoader loader) : state_(std::make_unique<State>(loader)) {}
Renderer::~Renderer() = default;

void Renderer::set_materials(const MaterialTable& materials) { state_->set_materials(materials); }

void Renderer::upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh) {
  state_->chunks.erase(key);
  if (!mesh.empty()) state_->chunks.emplace(key, ChunkBuffers(edge, mesh));
}

void Renderer::remove(const ChunkKey& key) { state_->chunks.erase(key); }

RenderStats Renderer::draw(const Camera& camera, int width, int height,
                           std::span<const Marker> markers) {
  RenderStats stats;
  state_->target.bind(width, height);
  const glm::vec3 forward{static_cast<float>(std::sin(camera.yaw) * std::cos(camera.pitch)),
                          static_cast<float>(std::sin(camera.pitch)),
                          static_cast<float>(std::cos(camera.yaw) * std::cos(camera.pitch))};
  // The up vector must not be parallel to the view, which may point straight up or down.
  const glm::vec3 up = std::abs(forward.y) > 0.999F
                           ? glm::vec3{static_cast<float>(std::sin(camera.yaw)), 0,
                                       static_cast<float>(std::cos(camera.yaw))}
                           : glm::vec3{0, 1, 0};
  const glm::mat4 view = glm::lookAt(glm::vec3{0}, forward, up);
  const glm::mat4 projection = glm::perspective(
      static_cast<float>(camera.fov_y), static_cast<float>(width) / static_cast<float>(height),
      static_cast<float>(camera.near), static_cast<float>(camera.far) * 1.1F);
  const glm::mat4 clip = projection * view;

  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
  state_->draw_sky(clip);
  state_->draw_chunks(camera, clip, stats);
  state_->draw_markers(camera, clip, markers);
  for (const auto& [key, buffers] : state_->chunks) stats.gpu_bytes += buffers.byte_size();
  return stats;
}

void Renderer::finish() {
  const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  // The wait is bounded, so that a driver that hangs does not block the client for ever.
  constexpr GLuint64 kNanosecondsMax = 30'000'000'000;
  const GLenum waited = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, kNanosecondsMax);
  glDeleteSync(fence);
  if (waited == GL_TIMEOUT_EXPIRED)
    throw std::runtime_error("the OpenGL driver did not finish a frame in 30 s");
  if (waited == GL_WAIT_FAILED) throw std::runtime_error("the OpenGL context is lost");
  if (glGetError() == GL_OUT_OF_MEMORY) throw std::runtime_error("the GPU has no memory left");
}

Image Renderer::read_image() {
  const FrameTarget& target = state_->target;
  if (target.width() == 0) throw std::runtime_error("read_image before the first draw");
  Image image{target.width(), target.height(), {}};
  const std::size_t row = static_cast<std::size_t>(image.width) * 3;
  std::vector<std::uint8_t> bottom_up(row * static_cast<std::size_t>(image.height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE, bottom_up.data());
  image.rgb.reserve(bottom_up.size());
  for (int y = image.height - 1; y >= 0; --y) {
    const auto begin =
        bottom_up.begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(y));
    image.rgb.insert(image.rgb.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
  }
  return image;
}

void Renderer::present(int window_width, int window_height) {
  const FrameTarget& target = state_->target;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, target.width(), target.height(), 0, 0, window_width, window_height,
                    GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

}  // namespace runstone
