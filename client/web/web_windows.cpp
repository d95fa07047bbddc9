#include "client/web/web_windows.hpp"

#include "client/web/page.hpp"

namespace runstone {

bool WebWindows::act(Action action) {
  if (action == Action::release) return windows_.close_one();
  if (!windows_.act(action)) return false;
  if (!std::exchange(is_font_requested_, true)) page_load_font();
  return true;
}

void WebWindows::set_font(ByteView font, double scale) {
  if (!context_) context_.emplace(scale, font);
}

UiFocus WebWindows::focus() const {
  UiFocus out;
  out.panels = windows_.count_with_mouse();
  if (!context_ || !windows_.is_any_open()) return out;
  out.types = windows_.has_fields() && context_->types();
  out.over_window = context_->over_window();
  return out;
}

bool WebWindows::has_window_at(double x, double y) const {
  return context_ && windows_.is_any_open() && context_->has_window_at(x, y);
}

void WebWindows::feed(const std::vector<InputEvent>& events) {
  if (context_ && windows_.is_any_open()) context_->feed(events);
}

std::shared_ptr<const OverlayFrame> WebWindows::make_frame(const HudState& state,
                                                           std::array<int, 2> size,
                                                           double seconds) {
  if (!context_) return nullptr;
  if (!windows_.is_any_open()) {
    context_->release_all();  // the releases of keys that are held come to no window
    return nullptr;
  }
  const auto make = [&] { windows_.build(state, *context_, actions_); };
  if (windows_.take_changed()) context_->make_hidden_frame(size, make);
  return context_->make_frame(size, seconds, make);
}

}  // namespace runstone
