#include "client/render/overlay_painter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace runstone {
namespace {

constexpr const char* kVertexShader =
    "layout(location = 0) in vec2 position;\n"
    "layout(location = 1) in vec2 place;\n"
    "layout(location = 2) in vec4 colour;\n"
    "uniform vec2 size;\n"
    "out vec2 texel;\n"
    "out vec4 tint;\n"
    "void main() {\n"
    "  texel = place;\n"
    "  tint = colour;\n"
    "  vec2 unit = position / size * 2.0 - 1.0;\n"
    "  gl_Position = vec4(unit.x, -unit.y, 0.0, 1.0);\n"
    "}\n";

constexpr const char* kFragmentShader =
    "in vec2 texel;\n"
    "in vec4 tint;\n"
    "uniform sampler2D picture;\n"
    "out vec4 fragment;\n"
    "void main() { fragment = tint * texture(picture, texel); }\n";

const void* offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

/// Makes `first` the vertex of index 0. OpenGL ES 3.0 has no draw call that does so.
void begin_vertices_at(std::uint32_t first) {
  constexpr GLsizei kStride = sizeof(OverlayVertex);
  const auto at = [first](std::size_t member) {
    return offset(first * sizeof(OverlayVertex) + member);
  };
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, kStride, at(offsetof(OverlayVertex, x)));
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, kStride, at(offsetof(OverlayVertex, u)));
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride,
                        at(offsetof(OverlayVertex, colour)));
}

/// Sets the scissor rectangle of a command. Returns false if it has no pixels.
bool clip_to(const OverlayCommand& command, double scale_x, double scale_y, int width, int height) {
  const auto pixel = [](float at, double scale, int most) {
    return std::clamp(static_cast<int>(std::lround(at * scale)), 0, most);
  };
  const int left = pixel(command.clip[0], scale_x, width);
  const int top = pixel(command.clip[1], scale_y, height);
  const int right = pixel(command.clip[2], scale_x, width);
  const int bottom = pixel(command.clip[3], scale_y, height);
  if (left >= right || top >= bottom) return false;
  glScissor(left, height - bottom, right - left, bottom - top);
  return true;
}

}  // namespace

OverlayPainter::OverlayPainter()
    : program_(link_program("overlay", kVertexShader, kFragmentShader)),
      array_(GlVertexArray::make()),
      vertices_(GlBuffer::make()),
      indices_(GlBuffer::make()),
      glyphs_(GlTexture::make()) {
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
  for (const GLuint attribute : {0U, 1U, 2U}) glEnableVertexAttribArray(attribute);
  glBindVertexArray(0);
}

void OverlayPainter::upload_atlas(const std::shared_ptr<const OverlayAtlas>& atlas) {
  glBindTexture(GL_TEXTURE_2D, glyphs_.get());
  if (atlas == atlas_) return;
  atlas_ = atlas;
  // The coverage of a glyph is its alpha, and its colour is white.
  std::vector<std::uint8_t> texels;
  texels.reserve(4 * atlas->coverage.size());
  for (const std::uint8_t coverage : atlas->coverage)
    texels.insert(texels.end(), {255, 255, 255, coverage});
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, atlas->width, atlas->height, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, texels.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

void OverlayPainter::upload_images(const OverlayFrame& frame) {
  std::map<std::shared_ptr<const OverlayImage>, GlTexture> before = std::exchange(images_, {});
  for (const auto& image : frame.images) {
    if (images_.contains(image)) continue;
    if (const auto known = before.find(image); known != before.end()) {
      images_.insert(before.extract(known));
      continue;
    }
    GlTexture texture = GlTexture::make();
    glBindTexture(GL_TEXTURE_2D, texture.get());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image->width, image->height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, image->pixels.data());
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    images_.emplace(image, std::move(texture));
  }
}

void OverlayPainter::draw(const OverlayFrame& frame, int width, int height) {
  if (frame.commands.empty() || frame.width <= 0 || frame.height <= 0) return;
  glActiveTexture(GL_TEXTURE0);
  upload_images(frame);
  upload_atlas(frame.atlas);
  glUseProgram(program_.get());
  glUniform2f(glGetUniformLocation(program_.get(), "size"), static_cast<float>(frame.width),
              static_cast<float>(frame.height));
  glUniform1i(glGetUniformLocation(program_.get(), "picture"), 0);
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBufferData(GL_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(frame.vertices.size() * sizeof(OverlayVertex)),
               frame.vertices.data(), GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(frame.indices.size() * sizeof(std::uint16_t)),
               frame.indices.data(), GL_STREAM_DRAW);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_SCISSOR_TEST);
  const double scale_x = static_cast<double>(width) / frame.width;
  const double scale_y = static_cast<double>(height) / frame.height;
  std::optional<std::uint32_t> first_vertex;
  for (const OverlayCommand& command : frame.commands) {
    if (!clip_to(command, scale_x, scale_y, width, height)) continue;
    glBindTexture(GL_TEXTURE_2D, command.image == 0
                                     ? glyphs_.get()
                                     : images_.at(frame.images[command.image - 1]).get());
    if (first_vertex != command.first_vertex) begin_vertices_at(command.first_vertex);
    first_vertex = command.first_vertex;
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.index_count), GL_UNSIGNED_SHORT,
                   offset(command.first_index * sizeof(std::uint16_t)));
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glBindVertexArray(0);
}

}  // namespace runstone
