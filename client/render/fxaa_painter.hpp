// FxaaPainter: smooths the edges of a finished picture: FXAA (Lottes, 2009). It finds edges by
// differences of brightness and mixes pixels along them. Thread: the GL thread.
#pragma once
#include "client/render/frame_target.hpp"
#include "client/render/gl_handle.hpp"

namespace runstone {

class FxaaPainter {
 public:
  /// Throws std::runtime_error with the driver's log if the shader does not compile.
  FxaaPainter();
  /// Draws `picture`, smoothed, over the whole bound framebuffer, which has its size and another
  /// colour buffer.
  void draw(const FrameTarget& picture);

 private:
  GlProgram program_;
  GlVertexArray array_;
};

}  // namespace runstone
