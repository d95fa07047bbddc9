// InspectionPainter: draws the modes of an Inspection over the faces of the last passes. It draws
// the quads of chunks and tiles once more, so its pattern lies exactly on the faces. Of tiles it
// shows the edges of quads alone. Thread: the GL thread.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>

#include "client/render/depth_range.hpp"
#include "client/render/gl_handle.hpp"
#include "client/render/inspection.hpp"
#include "client/render/material_textures.hpp"
#include "client/render/quad_buffer.hpp"
#include "client/render/texel_store.hpp"

namespace runstone {

class InspectionPainter {
 public:
  /// Throws std::runtime_error with the driver's log if the shader does not compile.
  InspectionPainter();

  /// Begins a pass over chunks. `clip` maps eye-relative coordinates to clip space. `inspection`
  /// must outlive the pass. The starts of runs are uploaded for at most kUploadsMax chunks, or for
  /// all with `exact`.
  void begin(const Inspection& inspection, const glm::mat4& clip, const DepthRange& depth,
             const QuadBuffer& quads, const MaterialTextures& materials, bool exact);
  /// Sets the chunk, tile or octant whose quads are drawn next. `origin` is relative to the eye,
  /// `edge` in voxels, and `scale` the width of a voxel. Returns false if nothing is shown of it.
  bool place(const ChunkKey& key, const glm::vec3& origin, std::int32_t edge, float scale);
  /// Returns what QuadBuffer::draw() takes. Valid after begin().
  GLint first_vertex() const { return first_vertex_; }
  static void end(const DepthRange& depth);

  static constexpr int kUploadsMax = 16;

 private:
  /// The starts of runs of a chunk on the GPU.
  struct Bits {
    std::shared_ptr<const RunChunk> voxels;
    std::uint32_t first = 0, words = 0;  // in bits_
    bool is_used = false;
  };
  void update_bits(bool exact);
  void upload(const InspectedChunk& chunk, Bits& bits);
  bool place_flash(const ChunkKey& key) const;
  GLint at(const char* uniform) const { return glGetUniformLocation(program_.get(), uniform); }

  GlProgram program_;
  GLint first_vertex_ = -1;
  TexelStore bits_;
  std::map<ChunkKey, Bits> chunks_;
  const Inspection* shown_ = nullptr;  // during a pass
};

}  // namespace runstone
