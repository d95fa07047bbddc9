// OpenGL without a display server, through EGL's surfaceless platform (Mesa).
#pragma once
#include <memory>
#include <string>

#include "client/platform/gl_context.hpp"

namespace runstone {

/// Returns null on failure and appends the reason to `tried`.
std::unique_ptr<GlContext> make_egl_surfaceless_context(std::string& tried);

}  // namespace runstone
