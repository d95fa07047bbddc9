// OpenGL in plain memory, for machines without EGL.
#pragma once
#include <memory>
#include <string>

#include "client/platform/gl_context.hpp"

namespace runstone {

/// Null on failure; the reason is appended to `tried`.
std::unique_ptr<GlContext> make_osmesa_context(std::string& tried);

}  // namespace runstone
