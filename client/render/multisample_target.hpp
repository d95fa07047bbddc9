// MultisampleTarget: a framebuffer with several samples a pixel (MSAA), which are mixed into a
// FrameTarget. Thread: the GL thread.
#pragma once
#include "client/render/frame_target.hpp"
#include "client/render/gl_handle.hpp"

namespace runstone {

class MultisampleTarget {
 public:
  /// Makes the framebuffer anew if size or samples changed. Returns false if the driver cannot make
  /// it.
  bool prepare(int width, int height, int samples);
  /// Binds the framebuffer for drawing. Requires prepare() before.
  void bind() const { glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get()); }
  /// Copies the colours to a target of the same size. The colour of a pixel is the mean of its
  /// samples. Leaves this framebuffer bound.
  void copy_colour(const FrameTarget& to) const { copy(to, GL_COLOR_BUFFER_BIT); }
  /// Copies the depths to a target of the same size. The depth of a pixel is that of one of its
  /// samples. Leaves this framebuffer bound.
  void copy_depth(const FrameTarget& to) const { copy(to, GL_DEPTH_BUFFER_BIT); }

 private:
  void copy(const FrameTarget& to, GLbitfield what) const;

  int width_ = 0, height_ = 0, samples_ = 0;
  GlFramebuffer framebuffer_;
  GlRenderbuffer colour_, depth_;
};

/// Returns the greatest number of samples a pixel that the driver has for a FrameTarget.
int samples_max();

}  // namespace runstone
