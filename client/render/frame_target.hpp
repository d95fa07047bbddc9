// FrameTarget: the off-screen framebuffer of a frame. Its depth is a texture, which water and the
// glow of lamps read to know how deep they are, and so is its colour, which FXAA reads.
#pragma once
#include "client/render/gl_handle.hpp"

namespace runstone {

class FrameTarget {
 public:
  /// Binds the framebuffer for drawing at this size. Makes a new one only if the size changed.
  /// Throws std::runtime_error if the driver cannot make one.
  void bind(int width, int height);
  /// Binds the framebuffer again, or its colour alone. Without the depth, a shader may read depth()
  /// and must compare it itself.
  void bind_all() const { glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get()); }
  void bind_colour() const { glBindFramebuffer(GL_FRAMEBUFFER, colour_framebuffer_.get()); }
  GLuint colour() const { return colour_.get(); }
  GLuint depth() const { return depth_.get(); }
  GLuint framebuffer() const { return framebuffer_.get(); }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  void resize(int width, int height);

  int width_ = 0, height_ = 0;
  GlFramebuffer framebuffer_, colour_framebuffer_;
  GlTexture colour_, depth_;
};

}  // namespace runstone
