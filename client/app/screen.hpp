// Screen: where frames go: a window, or an off-screen target. Main thread only.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "client/platform/gl_context.hpp"
#include "client/platform/window.hpp"
#include "client/render/renderer.hpp"

namespace runstone {

class Screen {
 public:
  /// Throw std::runtime_error if there is no OpenGL of that kind.
  static std::unique_ptr<Screen> headless(int width, int height);
  static std::unique_ptr<Screen> window(int width, int height, const std::string& title);

  Renderer& renderer() { return *renderer_; }
  const char* name() const { return context_->name(); }
  /// Null off screen.
  Window* window() { return window_; }

  /// Draws and waits until the picture is done: headless the fence after the frame, else the swap.
  RenderStats draw(const Camera& camera, std::span<const Marker> markers);

 private:
  Screen(std::unique_ptr<GlContext> context, Window* window, int width, int height);
  std::unique_ptr<GlContext> context_;
  Window* window_;  // context_, if it is one
  int width_, height_;
  std::unique_ptr<Renderer> renderer_;  // dies before its context
};

}  // namespace runstone
