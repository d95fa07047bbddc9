// OverlayPainter: draws overlay frames with OpenGL 3.3 core. Thread: the GL thread.
#pragma once
#include <map>
#include <memory>

#include "client/render/gl_handle.hpp"
#include "client/render/overlay_frame.hpp"

namespace runstone {

class OverlayPainter {
 public:
  /// Compiles the shader. Throws std::runtime_error with the driver's log on failure.
  OverlayPainter();

  /// Draws into the bound framebuffer, which has `width` x `height` pixels. A frame that was made
  /// for another size is stretched. Uploads the atlas if it is another one than last time, and the
  /// images that the frame before had not; forgets those that this one has not. Afterwards depth
  /// test and depth writes are on, and blending, culling and the scissor test are off. Cost:
  /// O(vertices + commands + images + pixels of new images).
  void draw(const OverlayFrame& frame, int width, int height);

 private:
  void upload_atlas(const std::shared_ptr<const OverlayAtlas>& atlas);
  void upload_images(const OverlayFrame& frame);

  GlProgram program_;
  GlVertexArray array_;
  GlBuffer vertices_, indices_;
  GlTexture glyphs_;
  std::shared_ptr<const OverlayAtlas> atlas_;  // the one in glyphs_
  /// The textures of the images of the last frame. The keys keep their addresses from being used by
  /// other images.
  std::map<std::shared_ptr<const OverlayImage>, GlTexture> images_;
};

}  // namespace runstone
