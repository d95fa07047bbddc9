// GlContext: a current OpenGL context and where it came from. Headless: EGL surfaceless first, OSMesa second
// (both without an X server). With a display: client/platform/window.hpp. Made current on the thread that
// makes it, and used and destroyed there.
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
  /// Address of a GL function, for the loader.
  using Loader = void (*(*)(const char*))();
  virtual Loader loader() const = 0;
  /// "EGL surfaceless", "OSMesa" or "GLFW".
  virtual const char* name() const = 0;
  /// Whether the default framebuffer is seen by anybody.
  virtual bool is_window() const { return false; }
  /// Shows the default framebuffer; may wait for the display. Off screen there is nothing to show.
  virtual void swap() {}
};

/// Throws std::runtime_error that lists every path tried and why it failed.
std::unique_ptr<GlContext> make_headless_context();

}  // namespace runstone
