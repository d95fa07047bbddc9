#include "tests/bench/frames/gl/plain_scene.hpp"

#include <cstddef>
#include <stdexcept>
#include <utility>

namespace runstone::bench {
namespace {

template <class T>
GlBuffer filled(GLenum target, const std::vector<T>& from) {
  GlBuffer buffer = GlBuffer::make();
  glBindBuffer(target, buffer.get());
  glBufferData(target, static_cast<GLsizeiptr>(from.size() * sizeof(T)), from.data(), GL_STATIC_DRAW);
  return buffer;
}

const void* offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

}  // namespace

void PlainScene::add(const glm::vec3& origin, unsigned edge, const IndexedMesh& mesh) {
  if (mesh.indices.empty()) return;
  Chunk chunk;
  chunk.origin = origin;
  chunk.centre = origin + 0.5F * static_cast<float>(edge);
  chunk.array = GlVertexArray::make();
  glBindVertexArray(chunk.array.get());
  chunk.vertices = filled(GL_ARRAY_BUFFER, mesh.vertices);
  chunk.indices = filled(GL_ELEMENT_ARRAY_BUFFER, mesh.indices);
  glEnableVertexAttribArray(0);
  glVertexAttribIPointer(0, 4, GL_UNSIGNED_BYTE, sizeof(IndexedVertex), offset(offsetof(IndexedVertex, x)));
  glEnableVertexAttribArray(1);
  glVertexAttribIPointer(1, 1, GL_UNSIGNED_SHORT, sizeof(IndexedVertex),
                         offset(offsetof(IndexedVertex, material)));
  if (glGetError() == GL_OUT_OF_MEMORY) throw std::runtime_error("the GPU has no memory left for a mesh");
  chunk.index_count = static_cast<GLsizei>(mesh.indices.size());
  vertices_ += mesh.vertices.size();
  triangles_ += mesh.indices.size() / 3;
  bytes_ += mesh.byte_size();
  chunks_.push_back(std::move(chunk));
}

}  // namespace runstone::bench
