#include "client/platform/egl_context.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <span>
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

template <class Function>
Function egl_function(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// Returns an initialized display without a screen, or EGL_NO_DISPLAY. Mesa has one for all its drivers.
/// Drivers of vendors have one for each device.
EGLDisplay screenless_display() {
  const auto get_display =
      egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (get_display == nullptr) return EGL_NO_DISPLAY;
  const auto initialized = [&](EGLenum platform, void* native) {
    const EGLDisplay display = get_display(platform, native, nullptr);
    const bool is_usable =
        display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE;
    return is_usable ? display : EGL_NO_DISPLAY;
  };
  const EGLDisplay surfaceless = initialized(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
  const auto query_devices = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  if (surfaceless != EGL_NO_DISPLAY || query_devices == nullptr) return surfaceless;
  std::array<EGLDeviceEXT, 8> devices{};
  EGLint count = 0;
  if (query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count) != EGL_TRUE)
    return EGL_NO_DISPLAY;
  for (const EGLDeviceEXT device : std::span(devices).first(static_cast<std::size_t>(count))) {
    const EGLDisplay display = initialized(EGL_PLATFORM_DEVICE_EXT, device);
    if (display != EGL_NO_DISPLAY) return display;
  }
  return EGL_NO_DISPLAY;
}

std::unique_ptr<GlContext> make_context(const Kind& kind, std::string& tried) {
  const auto give_up = [&](const char* why) {
    tried += std::string(kind.name) + ": " + why + "; ";
    return nullptr;
  };
  const EGLDisplay display = screenless_display();
  if (display == EGL_NO_DISPLAY) return give_up("no display");
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
