#include "client/render/gl_functions.hpp"

#include <stdexcept>
#include <string>
#include <string_view>

namespace runstone {
namespace {

bool loaded_es = false;

std::string_view version_text(GlContextLoader loader) {
  const auto get_string = reinterpret_cast<PFNGLGETSTRINGPROC>(loader("glGetString"));
  const auto* const text =
      get_string == nullptr ? nullptr : reinterpret_cast<const char*>(get_string(GL_VERSION));
  if (text == nullptr) throw std::runtime_error("the OpenGL loader found no functions");
  return text;
}

}  // namespace

void load_gl(GlContextLoader loader) {
  const std::string_view version = version_text(loader);
  loaded_es = version.starts_with("OpenGL ES");
  const int loaded = loaded_es ? gladLoadGLES2(loader) : gladLoadGL(loader);
  if (loaded < (loaded_es ? GLAD_MAKE_VERSION(3, 0) : GLAD_MAKE_VERSION(3, 3)))
    throw std::runtime_error("OpenGL 3.3 or OpenGL ES 3.0 is needed, and the context has version " +
                             std::string(version));
}

bool is_gl_es() { return loaded_es; }

PFNGLCLIPCONTROLPROC clip_control() {
  if (loaded_es) return GLAD_GL_EXT_clip_control != 0 ? glad_glClipControlEXT : nullptr;
  return GLAD_GL_VERSION_4_5 != 0 ? glad_glClipControl : nullptr;
}

bool has_texture_storage() { return loaded_es || GLAD_GL_VERSION_4_2 != 0; }

}  // namespace runstone
