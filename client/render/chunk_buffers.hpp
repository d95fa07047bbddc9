// ChunkBuffers: the quads of one chunk on the GPU, in one buffer: the opaque ones, then the
// transparent ones.
#pragma once
#include <cstdint>

#include "client/render/gl_handle.hpp"
#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"

namespace runstone {

class ChunkBuffers {
 public:
  ChunkBuffers(std::int32_t edge, const ChunkMesh& mesh);

  void draw_opaque() const { draw(0, opaque_); }
  void draw_transparent() const { draw(opaque_, transparent_); }
  std::int32_t edge() const { return edge_; }
  std::uint32_t opaque_count() const { return opaque_; }
  std::uint32_t transparent_count() const { return transparent_; }
  std::uint64_t byte_size() const { return std::uint64_t{8} * (opaque_ + transparent_); }

 private:
  void draw(std::uint32_t first, std::uint32_t count) const;
  std::int32_t edge_;
  std::uint32_t opaque_, transparent_;
  GlVertexArray array_;
  GlBuffer buffer_;
};

}  // namespace runstone
