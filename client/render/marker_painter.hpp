// MarkerPainter: draws boxes in one colour, filled or by their edges and diagonals. Thread: the GL
// thread.
#pragma once
#include <glm/glm.hpp>
#include <span>

#include "client/render/gl_handle.hpp"
#include "client/render/marker.hpp"

namespace runstone {

class MarkerPainter {
 public:
  /// Throws std::runtime_error with the driver's log if the shader does not compile.
  MarkerPainter();
  /// `clip` maps eye-relative coordinates to clip space. `eye` is in world voxels.
  void draw(std::span<const Marker> markers, const glm::dvec3& eye, const glm::mat4& clip);

 private:
  GlProgram program_;
  GlVertexArray array_;
  GlBuffer corners_;
};

}  // namespace runstone
