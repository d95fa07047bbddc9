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

/// A display without a screen that EGL may have.
struct Screenless {
  EGLenum platform;
  void* native;
};

/// Returns the displays to try, in this order: that of Mesa for all its drivers, then one for each
/// device of the drivers of vendors.
std::vector<Screenless> screenless_displays() {
  std::vector<Screenless> out = {{EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY}};
  const auto query_devices = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  std::array<EGLDeviceEXT, 8> devices{};
  EGLint count = 0;
  if (query_devices == nullptr ||
      query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count) != EGL_TRUE)
    return out;
  for (const EGLDeviceEXT device : std::span(devices).first(static_cast<std::size_t>(count)))
    out.push_back({EGL_PLATFORM_DEVICE_EXT, device});
  return out;
}

/// Makes a context of this kind current on an initialized display. Returns null if there is none.
std::unique_ptr<GlContext> make_context_on(EGLDisplay display, const Kind& kind) {
  eglBindAPI(kind.api);
  for (const std::vector<EGLint>& attributes : kind.attributes) {
    const EGLContext context =
        eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT) continue;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE)
      return std::make_unique<EglContext>(display, context, kind.name);
    eglDestroyContext(display, context);
  }
  return nullptr;
}

std::unique_ptr<GlContext> make_context(const Kind& kind, std::string& tried) {
  const auto get_display =
      egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  const char* failure = "no display";
  const auto displays = get_display == nullptr ? std::vector<Screenless>() : screenless_displays();
  for (const Screenless& screenless : displays) {
    const EGLDisplay display = get_display(screenless.platform, screenless.native, nullptr);
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) continue;
    if (auto context = make_context_on(display, kind)) return context;
    eglTerminate(display);
    failure = kind.none;
  }
  tried += std::string(kind.name) + ": " + failure + "; ";
  return nullptr;
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
