// GlContext: a current OpenGL context and where it came from. Headless: EGL surfaceless first, OSMesa second
// (both without an X server). With a display: client/platform/window.hpp. Belongs to the thread that made it.
#pragma once
#include <memory>
#include <string>

namespace runstone {

class GlContext {
 public:
  virtual ~GlContext() = default;
  virtual void make_current() = 0;
  /// Address of a GL function, for the loader.
  using Loader = void (*(*)(const char*))();
  virtual Loader loader() const = 0;
  /// "EGL surfaceless", "OSMesa" or "GLFW".
  virtual const char* name() const = 0;
};

/// Throws std::runtime_error that lists every path tried and why it failed.
std::unique_ptr<GlContext> make_headless_context();

}  // namespace runstone
