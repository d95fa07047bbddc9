#include "client/render/frame_target.hpp"

#include <stdexcept>

namespace runstone {

void FrameTarget::bind(int width, int height) {
  if (width != width_ || height != height_) resize(width, height);
  bind_all();
  glViewport(0, 0, width, height);
}

void FrameTarget::resize(int width, int height) {
  framebuffer_ = GlFramebuffer::make();
  colour_framebuffer_ = GlFramebuffer::make();
  colour_ = GlTexture::make();
  depth_ = GlTexture::make();
  const auto set_filter = [](GLint filter) {
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  };
  glBindTexture(GL_TEXTURE_2D, colour_.get());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  set_filter(GL_LINEAR);
  glBindTexture(GL_TEXTURE_2D, depth_.get());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT,
               GL_FLOAT, nullptr);
  set_filter(GL_NEAREST);
  for (const GLuint framebuffer : {colour_framebuffer_.get(), framebuffer_.get()}) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.get(), 0);
    if (framebuffer == framebuffer_.get())
      glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.get(), 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("the driver cannot make an off-screen target of this size");
  }
  width_ = width;
  height_ = height;
}

}  // namespace runstone
