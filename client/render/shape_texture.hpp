// ShapeTexture: the faces of all shapes on the GPU. The quads of a shape say which face of their
// material's shape they are (common/mesh/quad.hpp), and the vertex shader finds its rectangle here
// (quad_glsl.hpp). Texel m, for m below 65,536, is the place of the first face of material m, or 0
// if it is a cube; the faces lie behind. Thread: the GL thread.
#pragma once
#include <cstdint>
#include <vector>

#include "client/render/gl_handle.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

/// Returns the texels, whole rows of kTexelRow. A face has five bits each, from the lowest bit on:
/// depth, far_depth, u0, u1, v0 and v1. Cost: O(materials + faces).
std::vector<std::uint32_t> shape_texels(const ShapeTable& shapes);

class ShapeTexture {
 public:
  /// Makes the texture of a table of cubes.
  ShapeTexture();
  void set(const ShapeTable& shapes);
  /// Binds the texture to a texture unit, and sets the uniform `shapes`. Requires that the program
  /// is in use.
  void bind(const GlProgram& program, GLint unit) const;
  std::uint64_t byte_size() const { return bytes_; }

 private:
  GlTexture texture_;
  std::uint64_t bytes_ = 0;
};

}  // namespace runstone
