// GhostPainter: draws the previews of edits over the world. Their quads stay on the GPU as long as
// frames show them. Thread: the GL thread.
#pragma once
#include <map>
#include <memory>
#include <span>

#include "client/render/frame_view.hpp"
#include "client/render/ghost.hpp"
#include "client/render/gl_handle.hpp"
#include "client/render/material_textures.hpp"
#include "client/render/quad_buffer.hpp"
#include "common/mesh/chunk_mesh.hpp"

namespace runstone {

class GhostPainter {
 public:
  /// Throws std::runtime_error with the driver's log if a shader does not compile.
  GhostPainter();
  /// Draws the ghosts, and removes the quads of others from `quads`. Requires the same `quads` in
  /// all calls.
  void draw(const FrameView& view, std::span<const GhostChunk> ghosts,
            const MaterialTextures& materials, QuadBuffer& quads);

 private:
  /// The quads of a ghost's mesh.
  struct GhostQuads {
    std::shared_ptr<const ChunkMesh> mesh;
    QuadSpan quads;
    bool is_used = false;
  };
  /// Copies the quads of a mesh to the GPU, unless they are there or there are none.
  void hold(const std::shared_ptr<const ChunkMesh>& mesh, QuadBuffer& quads);
  /// Holds the quads of these ghosts, and removes those of others.
  void hold_only(std::span<const GhostChunk> ghosts, QuadBuffer& quads);

  GlProgram program_;
  std::map<const ChunkMesh*, GhostQuads> held_;
};

}  // namespace runstone
