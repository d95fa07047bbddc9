#include "client/platform/egl_context.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>

namespace runstone {
namespace {

class EglContext final : public GlContext {
 public:
  EglContext(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
  ~EglContext() override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
  }

  Loader loader() const override { return &eglGetProcAddress; }
  const char* name() const override { return "EGL surfaceless"; }

 private:
  EGLDisplay display_;
  EGLContext context_;
};

}  // namespace

std::unique_ptr<GlContext> make_egl_surfaceless_context(std::string& tried) {
  const auto give_up = [&tried](const char* why) {
    tried += std::string("EGL surfaceless: ") + why + "; ";
    return nullptr;
  };
  const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (get_display == nullptr) return give_up("no eglGetPlatformDisplayEXT");
  const EGLDisplay display =
      get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE)
    return give_up("no display");
  eglBindAPI(EGL_OPENGL_API);
  constexpr std::array<std::array<EGLint, 2>, 2> kVersions = {{{4, 5}, {3, 3}}};
  for (const auto& [major, minor] : kVersions) {
    const std::array<EGLint, 7> attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                              major,
                                              EGL_CONTEXT_MINOR_VERSION,
                                              minor,
                                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                              EGL_NONE};
    const EGLContext context =
        eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT) continue;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) {
      return std::make_unique<EglContext>(display, context);
    }
    eglDestroyContext(display, context);
  }
  eglTerminate(display);
  return give_up("no 4.5 or 3.3 core context");
}

}  // namespace runstone
