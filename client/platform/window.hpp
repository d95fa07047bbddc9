// Window: a GLFW window and the input of one frame: main thread only, as GLFW wants it. Its OpenGL context is
// the other half, for the one thread that draws.
#pragma once
#include <array>
#include <memory>
#include <string>

#include "client/platform/gl_context.hpp"

namespace runstone {

/// What the player did since the last poll.
struct WindowInput {
  bool forward = false, back = false, left = false, right = false, up = false, down = false,
       fast = false;                // held
  double look_dx = 0, look_dy = 0;  // pixels the mouse moved while captured, y downward
  int remove_clicks = 0;            // left button presses
  int place_clicks = 0;             // right button presses
  int digit = -1;                   // number key pressed, 0..9, or -1
  int scroll = 0;                   // wheel steps, up positive
  bool escape = false;      // pressed while the mouse was free (the first press only frees it)
  bool screenshot = false;  // F2 pressed
  int scrub = 0;            // ] less [ pressed: later or earlier
  bool undo = false, redo = false;  // Ctrl+Z, Ctrl+Y pressed
  bool live = false;                // Home pressed
  bool close = false;               // the window's close button
};

class Window {
 public:
  /// Throws std::runtime_error with GLFW's words if there is no display or no 4.5 or 3.3 core context.
  Window(int width, int height, const std::string& title);
  /// Its context must be gone.
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Collects events since the last call. Clicks count only while the mouse is captured; the first click
  /// captures it.
  WindowInput poll();
  void set_title(const std::string& title);
  /// Pixels, each at least 1 (a minimised window has none on some systems).
  std::array<int, 2> framebuffer_size() const;
  bool mouse_captured() const;

 private:
  friend std::unique_ptr<GlContext> make_window_context(Window& window);
  struct State;
  std::unique_ptr<State> state_;
};

/// Makes the window's context current on this thread, until what is returned is destroyed there. One at a
/// time; `window` must outlive it. Throws std::runtime_error with GLFW's words.
std::unique_ptr<GlContext> make_window_context(Window& window);

}  // namespace runstone
