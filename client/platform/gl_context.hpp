// GlContext: a current OpenGL context. Off screen it is made by EGL without a surface or, if that
// fails, by OSMesa, or by EGL for OpenGL ES 3.0. None of them needs an X server.
// client/platform/window.hpp makes the context of a window. Thread: the context is current on the
// thread that makes it, and is used and destroyed there.
#pragma once
#include <memory>
#include <string>

namespace runstone {

class GlContext {
 public:
  GlContext() = default;
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  /// Returns the address of a GL function by its name.
  using Loader = void (*(*)(const char*))();
  virtual Loader loader() const = 0;
  /// Returns "EGL surfaceless" (also for a device of a vendor's driver), "EGL surfaceless, OpenGL
  /// ES", "OSMesa", "GLFW", "GLFW, OpenGL ES" or "WebGL 2".
  virtual const char* name() const = 0;
  /// Returns true if the default framebuffer is that of a window.
  virtual bool is_window() const { return false; }
  /// Returns true if the thread may wait for the GPU.
  virtual bool can_wait() const { return true; }
  /// Shows the default framebuffer in the window; may wait for the display. Does nothing off
  /// screen.
  virtual void swap() {}
};

/// Throws std::runtime_error that lists each attempt and why it failed.
std::unique_ptr<GlContext> make_headless_context();

}  // namespace runstone
