// The WebGL 2 context of a canvas of the page, which is OpenGL ES 3.0. Thread: the page's only one.
#pragma once
#include <memory>

#include "client/platform/gl_context.hpp"

namespace runstone {

/// `selector` names the canvas, as in a style sheet; a static string. Throws std::runtime_error if
/// the browser gives no context of WebGL 2.
std::unique_ptr<GlContext> make_canvas_context(const char* selector);

}  // namespace runstone
