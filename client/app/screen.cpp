#include "client/app/screen.hpp"

#include <utility>

namespace runstone {

Screen::Screen(std::unique_ptr<GlContext> context, Window* window, int width, int height)
    : context_(std::move(context)), window_(window), width_(width), height_(height) {
  context_->make_current();
  renderer_ = std::make_unique<Renderer>(context_->loader());
}

std::unique_ptr<Screen> Screen::headless(int width, int height) {
  return std::unique_ptr<Screen>(new Screen(make_headless_context(), nullptr, width, height));
}

std::unique_ptr<Screen> Screen::window(int width, int height, const std::string& title) {
  auto window = std::make_unique<Window>(width, height, title);
  Window* const raw = window.get();
  return std::unique_ptr<Screen>(new Screen(std::move(window), raw, width, height));
}

RenderStats Screen::draw(const Camera& camera, std::span<const Marker> markers) {
  if (window_ == nullptr) {
    const RenderStats stats = renderer_->draw(camera, width_, height_, markers);
    renderer_->finish();
    return stats;
  }
  const auto [width, height] = window_->framebuffer_size();
  if (width <= 0 || height <= 0) return {};  // minimised
  const RenderStats stats = renderer_->draw(camera, width, height, markers);
  renderer_->present(width, height);
  renderer_->finish();
  window_->swap();
  return stats;
}

}  // namespace runstone
