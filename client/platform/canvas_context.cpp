#include "client/platform/canvas_context.hpp"

#include <emscripten/html5.h>
#include <emscripten/html5_webgl.h>

#include <stdexcept>

namespace runstone {
namespace {

using Function = void (*)();

Function load(const char* name) {
  return reinterpret_cast<Function>(emscripten_webgl_get_proc_address(name));
}

class CanvasContext final : public GlContext {
 public:
  explicit CanvasContext(EMSCRIPTEN_WEBGL_CONTEXT_HANDLE context) : context_(context) {}
  ~CanvasContext() override { emscripten_webgl_destroy_context(context_); }
  Loader loader() const override { return load; }
  const char* name() const override { return "WebGL 2"; }
  bool is_window() const override { return true; }
  // A page must not wait: the browser shows the canvas after the function of the frame returns.
  bool can_wait() const override { return false; }

 private:
  const EMSCRIPTEN_WEBGL_CONTEXT_HANDLE context_;
};

}  // namespace

std::unique_ptr<GlContext> make_canvas_context(const char* selector) {
  EmscriptenWebGLContextAttributes wanted;
  emscripten_webgl_init_context_attributes(&wanted);
  wanted.majorVersion = 2;
  wanted.alpha = false;
  wanted.depth = false;  // the renderer has targets of its own
  wanted.antialias = false;
  wanted.powerPreference = EM_WEBGL_POWER_PREFERENCE_HIGH_PERFORMANCE;
  const EMSCRIPTEN_WEBGL_CONTEXT_HANDLE context =
      emscripten_webgl_create_context(selector, &wanted);
  if (context <= 0 || emscripten_webgl_make_context_current(context) != EMSCRIPTEN_RESULT_SUCCESS)
    throw std::runtime_error("the browser gives no context of WebGL 2");
  return std::make_unique<CanvasContext>(context);
}

}  // namespace runstone
