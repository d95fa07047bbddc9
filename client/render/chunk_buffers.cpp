#include "client/render/chunk_buffers.hpp"

namespace runstone {

ChunkBuffers::ChunkBuffers(std::int32_t edge, const ChunkMesh& mesh)
    : edge_(edge),
      opaque_(static_cast<std::uint32_t>(mesh.opaque.quads.size())),
      transparent_(static_cast<std::uint32_t>(mesh.transparent.quads.size())),
      array_(GlVertexArray::make()),
      buffer_(GlBuffer::make()) {
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(byte_size()), nullptr, GL_STATIC_DRAW);
  const auto opaque_bytes = static_cast<GLsizeiptr>(opaque_ * sizeof(Quad));
  glBufferSubData(GL_ARRAY_BUFFER, 0, opaque_bytes, mesh.opaque.quads.data());
  glBufferSubData(GL_ARRAY_BUFFER, opaque_bytes,
                  static_cast<GLsizeiptr>(transparent_ * sizeof(Quad)),
                  mesh.transparent.quads.data());
  glEnableVertexAttribArray(0);
  glVertexAttribDivisor(0, 1);
}

void ChunkBuffers::draw(std::uint32_t first, std::uint32_t count) const {
  if (count == 0) return;
  glBindVertexArray(array_.get());
  // OpenGL 3.3 has no base instance, so the attribute pointer is set to the first quad.
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glVertexAttribIPointer(
      0, 2, GL_UNSIGNED_INT, sizeof(Quad),
      reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first * sizeof(Quad))));
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
}

}  // namespace runstone
