#include "client/render/multisample_target.hpp"

namespace runstone {

bool MultisampleTarget::prepare(int width, int height, int samples) {
  if (width == width_ && height == height_ && samples == samples_) return true;
  framebuffer_ = GlFramebuffer::make();
  width_ = height_ = samples_ = 0;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  // The formats are those of FrameTarget, because a copy of samples converts nothing.
  const auto attach = [&](GlRenderbuffer& to, GLenum format, GLenum place) {
    to = GlRenderbuffer::make();
    glBindRenderbuffer(GL_RENDERBUFFER, to.get());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, to.get());
  };
  attach(colour_, GL_RGBA8, GL_COLOR_ATTACHMENT0);
  attach(depth_, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) return false;
  width_ = width;
  height_ = height;
  samples_ = samples;
  return true;
}

void MultisampleTarget::copy(const FrameTarget& to, GLbitfield what) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to.framebuffer());
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, what, GL_NEAREST);
  bind();
}

int samples_max() {
  GLint samples = 0;
  glGetIntegerv(GL_MAX_SAMPLES, &samples);
  return samples;
}

}  // namespace runstone
