#include "client/render/quad_buffer.hpp"

#include <algorithm>

namespace runstone {
namespace {

/// Indices of 16 bits reach this many quads. A longer span is drawn in parts.
constexpr std::uint32_t kQuadsMax = 65536 / 4;
constexpr std::uint32_t kQuadsAtFirst = 1U << 17;

}  // namespace

QuadBuffer::QuadBuffer()
    : store_(TexelFormat::rg32, kQuadsAtFirst),
      array_(GlVertexArray::make()),
      indices_(GlBuffer::make()) {
  std::vector<std::uint16_t> indices;
  indices.reserve(std::size_t{kQuadsMax} * 6);
  for (std::uint32_t quad = 0; quad < kQuadsMax; ++quad) {
    for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U})
      indices.push_back(static_cast<std::uint16_t>(4 * quad + corner));
  }
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint16_t)), indices.data(),
               GL_STATIC_DRAW);
  glBindVertexArray(0);
}

std::uint32_t QuadBuffer::add(std::span<const Quad> quads) {
  return store_.add(quads.data(), static_cast<std::uint32_t>(quads.size()));
}

GLint QuadBuffer::bind(const GlProgram& program, GLint unit) const {
  glBindVertexArray(array_.get());
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, store_.texture());
  glUniform1i(glGetUniformLocation(program.get(), "quads"), unit);
  shapes_.bind(program, kShapeUnit);
  return glGetUniformLocation(program.get(), "first_vertex");
}

void QuadBuffer::draw(std::span<const QuadSpan> spans, GLint first_vertex) {
  counts_.clear();
  bases_.clear();
  for (const QuadSpan& span : spans) {
    for (std::uint32_t done = 0; done < span.count; done += kQuadsMax) {
      counts_.push_back(static_cast<GLsizei>(6 * std::min(span.count - done, kQuadsMax)));
      bases_.push_back(static_cast<GLint>(4 * (span.first + done)));
    }
  }
  if (counts_.empty()) return;
  if (is_gl_es()) {
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      glUniform1i(first_vertex, bases_[i]);
      glDrawElements(GL_TRIANGLES, counts_[i], GL_UNSIGNED_SHORT, nullptr);
    }
    return;
  }
  offsets_.assign(counts_.size(), nullptr);
  glMultiDrawElementsBaseVertex(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_SHORT, offsets_.data(),
                                static_cast<GLsizei>(counts_.size()), bases_.data());
}

}  // namespace runstone
