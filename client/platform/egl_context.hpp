// OpenGL and OpenGL ES without a display server, through EGL: the surfaceless platform of Mesa, or
// a device of a vendor's driver.
#pragma once
#include <memory>
#include <string>

#include "client/platform/gl_context.hpp"

namespace runstone {

/// Return a context of OpenGL 4.5 or 3.3 core, and one of OpenGL ES 3.0 or newer. On failure they
/// return null and append the reason to `tried`.
std::unique_ptr<GlContext> make_egl_surfaceless_context(std::string& tried);
std::unique_ptr<GlContext> make_egl_surfaceless_es_context(std::string& tried);

}  // namespace runstone
