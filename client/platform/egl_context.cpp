#include "client/platform/egl_context.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <vector>

namespace runstone {
namespace {

class EglContext final : public GlContext {
 public:
  EglContext(EGLDisplay display, EGLContext context, const char* name)
      : display_(display), context_(context), name_(name) {}
  ~EglContext() override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
  }

  Loader loader() const override { return &eglGetProcAddress; }
  const char* name() const override { return name_; }

 private:
  EGLDisplay display_;
  EGLContext context_;
  const char* name_;
};

/// A kind of context, and the attributes to ask for, the best first.
struct Kind {
  const char* name;
  EGLenum api;
  std::vector<std::vector<EGLint>> attributes;
  const char* none;  // the failure if there is none
};

std::unique_ptr<GlContext> make_context(const Kind& kind, std::string& tried) {
  const auto give_up = [&](const char* why) {
    tried += std::string(kind.name) + ": " + why + "; ";
    return nullptr;
  };
  const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (get_display == nullptr) return give_up("no eglGetPlatformDisplayEXT");
  const EGLDisplay display =
      get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE)
    return give_up("no display");
  eglBindAPI(kind.api);
  for (const std::vector<EGLint>& attributes : kind.attributes) {
    const EGLContext context =
        eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT) continue;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) {
      return std::make_unique<EglContext>(display, context, kind.name);
    }
    eglDestroyContext(display, context);
  }
  eglTerminate(display);
  return give_up(kind.none);
}

std::vector<EGLint> core_profile(EGLint major, EGLint minor) {
  return {EGL_CONTEXT_MAJOR_VERSION,
          major,
          EGL_CONTEXT_MINOR_VERSION,
          minor,
          EGL_CONTEXT_OPENGL_PROFILE_MASK,
          EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
          EGL_NONE};
}

}  // namespace

std::unique_ptr<GlContext> make_egl_surfaceless_context(std::string& tried) {
  return make_context({"EGL surfaceless",
                       EGL_OPENGL_API,
                       {core_profile(4, 5), core_profile(3, 3)},
                       "no 4.5 or 3.3 core context"},
                      tried);
}

std::unique_ptr<GlContext> make_egl_surfaceless_es_context(std::string& tried) {
  return make_context({"EGL surfaceless, OpenGL ES",
                       EGL_OPENGL_ES_API,
                       {{EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE}},
                       "no context of OpenGL ES 3.0"},
                      tried);
}

}  // namespace runstone
