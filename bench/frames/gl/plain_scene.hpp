// PlainScene: one mesher's block of chunks on the GPU: indexed triangles with a vertex and an index
// buffer for each chunk, or packed quads with one buffer for each.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bench/frames/indexed_mesh.hpp"
#include "client/render/gl_handle.hpp"
#include "common/mesh/quad.hpp"

namespace runstone::bench {

class PlainScene {
 public:
  /// Uploads a chunk of `edge` voxels a side that begins at `origin` in the block. Uploads nothing
  /// if it is empty. Throws std::runtime_error if the GPU has no memory left.
  void add(const glm::vec3& origin, unsigned edge, const IndexedMesh& mesh);
  /// Uploads a chunk of packed quads. All chunks of a scene have one form.
  void add(const glm::vec3& origin, unsigned edge, std::span<const Quad> quads);

  std::size_t vertices() const { return vertices_; }
  std::size_t triangles() const { return triangles_; }
  std::size_t byte_size() const { return bytes_; }

 private:
  friend class PlainRenderer;
  struct Chunk {
    glm::vec3 origin, centre;
    GlVertexArray array;
    GlBuffer vertices, indices;
    GLsizei count = 0;  // indices, or quads
  };
  Chunk& new_chunk(const glm::vec3& origin, unsigned edge);

  bool packed_ = false;
  std::vector<Chunk> chunks_;
  std::size_t vertices_ = 0, triangles_ = 0, bytes_ = 0;
};

}  // namespace runstone::bench
