// FrameTarget: the off-screen framebuffer of a frame.
#pragma once
#include "client/render/gl_handle.hpp"

namespace runstone {

class FrameTarget {
 public:
  /// Binds the framebuffer for drawing at this size. Makes a new one only if the size changed.
  /// Throws std::runtime_error if the driver cannot make one.
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
