#include "client/app/client_display.hpp"

#include <spdlog/spdlog.h>

namespace runstone {
namespace {

/// Returns null if frames go to no window.
std::unique_ptr<Window> make_window(const ClientOptions& options) {
  if (!options.render || options.headless) return nullptr;
  return std::make_unique<Window>(options.width, options.height, "Runstone");
}

/// Returns null if nothing is drawn.
std::unique_ptr<DrawThread> make_draw_thread(const ClientOptions& options, Window* window,
                                             WakeUp& wake) {
  if (!options.render) return nullptr;
  const auto make = [window] {
    return make_screen(window == nullptr ? make_headless_context() : make_window_context(*window));
  };
  // Off screen, frames must not delay the threads whose latency is measured.
  const auto priority = window == nullptr ? DrawPriority::background : DrawPriority::normal;
  return std::make_unique<DrawThread>(make, priority, [&wake] { wake.notify(); });
}

}  // namespace

ClientDisplay::ClientDisplay(const ClientOptions& options)
    : window(make_window(options)), draw_thread(make_draw_thread(options, window.get(), wake)) {
  spdlog::info("renderer={}", draw_thread ? draw_thread->screen_name() : "none");
}

}  // namespace runstone
