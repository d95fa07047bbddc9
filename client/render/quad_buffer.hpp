// QuadBuffer: the quads of all chunks in one texture on the GPU, and the calls that draw spans of
// it. A vertex shader reads the quads from a texture (quad_glsl.hpp). So spans of any chunks are
// drawn by one call, and OpenGL 3.3, which has no base instance, suffices. OpenGL ES takes a call
// for each span. The faces of shapes, to which quads refer, lie beside it. Thread: the GL thread.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "client/render/gl_handle.hpp"
#include "client/render/quad_spans.hpp"
#include "client/render/shape_texture.hpp"
#include "client/render/texel_store.hpp"
#include "common/mesh/quad.hpp"

namespace runstone {

class QuadBuffer {
 public:
  QuadBuffer();
  /// Copies quads to the GPU and returns the place of the first one. Requires at least one quad.
  std::uint32_t add(std::span<const Quad> quads);
  void remove(QuadSpan span) {
    if (span.count != 0) store_.remove(span.first, span.count);
  }
  /// Sets the shapes of the materials of the quads.
  void set_shapes(const ShapeTable& shapes) { shapes_.set(shapes); }
  /// Binds quads, shapes and indices, and sets the uniforms `quads` and `shapes`; the shapes are
  /// bound to kShapeUnit. Requires that the program is in use. Returns the location of its uniform
  /// `first_vertex`, -1 in OpenGL, which draw() takes.
  GLint bind(const GlProgram& program, GLint unit) const;
  /// Draws the spans in their order. Requires bind() before, and that its program is in use.
  void draw(std::span<const QuadSpan> spans, GLint first_vertex);
  std::uint64_t used_bytes() const { return store_.used_bytes(); }
  std::uint64_t shape_bytes() const { return shapes_.byte_size(); }
  /// The texture unit of the shapes, which no other texture of a program may have.
  static constexpr GLint kShapeUnit = 7;

 private:
  TexelStore store_;
  ShapeTexture shapes_;
  GlVertexArray array_;
  GlBuffer indices_;
  std::vector<GLsizei> counts_;  // arguments of the call, kept for their capacity
  std::vector<GLint> bases_;
  std::vector<const void*> offsets_;
};

}  // namespace runstone
