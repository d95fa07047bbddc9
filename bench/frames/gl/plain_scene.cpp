#include "bench/frames/gl/plain_scene.hpp"

#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace runstone::bench {
namespace {

GlBuffer filled(GLenum target, const void* from, std::size_t bytes) {
  GlBuffer buffer = GlBuffer::make();
  glBindBuffer(target, buffer.get());
  glBufferData(target, static_cast<GLsizeiptr>(bytes), from, GL_STATIC_DRAW);
  if (glGetError() == GL_OUT_OF_MEMORY)
    throw std::runtime_error("the GPU has no memory left for a mesh");
  return buffer;
}

const void* offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

}  // namespace

PlainScene::Chunk& PlainScene::new_chunk(const glm::vec3& origin, unsigned edge) {
  Chunk& chunk = chunks_.emplace_back();
  chunk.origin = origin;
  chunk.centre = origin + 0.5F * static_cast<float>(edge);
  chunk.array = GlVertexArray::make();
  glBindVertexArray(chunk.array.get());
  return chunk;
}

void PlainScene::add(const glm::vec3& origin, unsigned edge, const IndexedMesh& mesh) {
  if (mesh.indices.empty()) return;
  Chunk& chunk = new_chunk(origin, edge);
  chunk.vertices =
      filled(GL_ARRAY_BUFFER, mesh.vertices.data(), mesh.vertices.size() * sizeof(IndexedVertex));
  chunk.indices = filled(GL_ELEMENT_ARRAY_BUFFER, mesh.indices.data(),
                         mesh.indices.size() * sizeof(std::uint32_t));
  chunk.count = static_cast<GLsizei>(mesh.indices.size());
  glEnableVertexAttribArray(0);
  glVertexAttribIPointer(0, 4, GL_UNSIGNED_BYTE, sizeof(IndexedVertex),
                         offset(offsetof(IndexedVertex, x)));
  glEnableVertexAttribArray(1);
  glVertexAttribIPointer(1, 1, GL_UNSIGNED_SHORT, sizeof(IndexedVertex),
                         offset(offsetof(IndexedVertex, material)));
  vertices_ += mesh.vertices.size();
  triangles_ += mesh.indices.size() / 3;
  bytes_ += mesh.byte_size();
}

void PlainScene::add(const glm::vec3& origin, unsigned edge, std::span<const Quad> quads) {
  packed_ = true;
  if (quads.empty()) return;
  Chunk& chunk = new_chunk(origin, edge);
  chunk.vertices = filled(GL_ARRAY_BUFFER, quads.data(), quads.size_bytes());
  chunk.count = static_cast<GLsizei>(quads.size());
  glEnableVertexAttribArray(0);
  glVertexAttribDivisor(0, 1);
  glVertexAttribIPointer(0, 2, GL_UNSIGNED_INT, sizeof(Quad), nullptr);
  vertices_ += 4 * quads.size();
  triangles_ += 2 * quads.size();
  bytes_ += quads.size_bytes();
}

}  // namespace runstone::bench
