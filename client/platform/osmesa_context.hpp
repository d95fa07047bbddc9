// OpenGL in main memory, for machines without EGL.
#pragma once
#include <memory>
#include <string>

#include "client/platform/gl_context.hpp"

namespace runstone {

/// Returns null on failure and appends the reason to `tried`.
std::unique_ptr<GlContext> make_osmesa_context(std::string& tried);

}  // namespace runstone
