#include "client/platform/gl_context.hpp"

#include <stdexcept>

#include "client/platform/egl_context.hpp"
#include "client/platform/osmesa_context.hpp"

namespace runstone {

std::unique_ptr<GlContext> make_headless_context() {
  std::string tried;
  if (auto context = make_egl_surfaceless_context(tried)) return context;
  if (auto context = make_osmesa_context(tried)) return context;
  if (auto context = make_egl_surfaceless_es_context(tried)) return context;
  throw std::runtime_error("no headless OpenGL context: " + tried);
}

}  // namespace runstone
