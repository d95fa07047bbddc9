// FrameTarget: the off-screen picture a frame is drawn into; grows and shrinks with the size asked for.
#pragma once
#include "client/render/gl_handle.hpp"

namespace runstone {

class FrameTarget {
 public:
  /// Binds the target for drawing at this size, making it anew only when the size changed.
  void bind(int width, int height);
  GLuint framebuffer() const { return framebuffer_.get(); }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  int width_ = 0, height_ = 0;
  GlFramebuffer framebuffer_;
  GlRenderbuffer colour_, depth_;
};

}  // namespace runstone
