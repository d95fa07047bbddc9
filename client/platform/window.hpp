// Window: a GLFW window and its input. Thread: the main thread only, as GLFW requires.
// make_window_context() gives the thread that draws the window's OpenGL context.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "client/input/input_event.hpp"
#include "client/platform/gl_context.hpp"

namespace runstone {

/// The events since the last poll.
struct WindowEvents {
  std::vector<InputEvent> events;
  std::vector<std::string> dropped;  // paths of files that were dropped on the window
  bool close = false;                // the window's close button was pressed
};

class Window {
 public:
  /// Throws std::runtime_error with GLFW's error text if there is no display, or no context of
  /// OpenGL 4.5 or 3.3 core or OpenGL ES 3.0.
  Window(int width, int height, const std::string& title);
  /// Requires that the window's context has been destroyed.
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Returns the events since the last call.
  WindowEvents poll();
  /// Captures the mouse, which hides its cursor and lets it move without an end, or frees it.
  void set_captured(bool is_captured);
  void set_title(const std::string& title);
  /// Returns width and height in pixels, each at least 1, although a minimised window has size 0 on
  /// some systems.
  std::array<int, 2> framebuffer_size() const;
  bool has_focus() const;

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
