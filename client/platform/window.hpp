// Window: a GLFW window and its input. Thread: the main thread only, as GLFW requires.
// make_window_context() gives the thread that draws the window's OpenGL context.
#pragma once
#include <array>
#include <memory>
#include <string>

#include "client/platform/gl_context.hpp"

namespace runstone {

/// The input since the last poll.
struct WindowInput {
  bool forward = false, back = false, left = false, right = false, up = false, down = false,
       fast = false;                // keys held down
  double look_dx = 0, look_dy = 0;  // pixels the mouse moved while captured, y downward
  int remove_clicks = 0;            // left button presses
  int place_clicks = 0;             // right button presses
  int pick_clicks = 0;              // middle button presses
  bool remove_held = false, place_held = false;  // left and right button held down
  int digit = -1;                                // number key pressed, 0 to 9, or -1
  int scroll = 0;                                // wheel steps, up positive
  bool escape = false;              // pressed while the mouse was free; the first press frees it
  bool screenshot = false;          // F2 pressed
  int scrub = 0;                    // presses of ] (later) minus presses of [ (earlier)
  bool undo = false, redo = false;  // Ctrl+Z, Ctrl+Y pressed, by the letters on the keys
  bool live = false;                // Home pressed
  int ground = 0;                   // presses of G
  int walking = 0;                  // presses of F
  bool close = false;               // the window's close button
};

class Window {
 public:
  /// Throws std::runtime_error with GLFW's error text if there is no display or no 4.5 or 3.3 core
  /// context.
  Window(int width, int height, const std::string& title);
  /// Requires that the window's context has been destroyed.
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Returns the input since the last call. The first click captures the mouse. Clicks count only
  /// while the mouse is captured.
  WindowInput poll();
  void set_title(const std::string& title);
  /// Returns width and height in pixels, each at least 1, although a minimised window has size 0 on
  /// some systems.
  std::array<int, 2> framebuffer_size() const;
  bool mouse_captured() const;

 private:
  friend std::unique_ptr<GlContext> make_window_context(Window& window);
  struct State;
  std::unique_ptr<State> state_;
};

/// Makes the window's context current on this thread until the returned object is destroyed there.
/// Only one may exist at a time, and `window` must outlive it. Throws std::runtime_error with
/// GLFW's error text.
std::unique_ptr<GlContext> make_window_context(Window& window);

}  // namespace runstone
