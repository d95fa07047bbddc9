#include "client/platform/osmesa_context.hpp"

#include <GL/osmesa.h>

#include <array>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace runstone {
namespace {

// Frames are drawn into framebuffer objects. OSMesa still requires a buffer as the window of a
// context.
constexpr int kWindowSide = 16;

class OsmesaContext final : public GlContext {
 public:
  explicit OsmesaContext(OSMesaContext context)
      : context_(context), window_(4UL * kWindowSide * kWindowSide) {}
  ~OsmesaContext() override { OSMesaDestroyContext(context_); }

  bool try_make_current() {
    return OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, kWindowSide,
                             kWindowSide) == GL_TRUE;
  }
  Loader loader() const override { return &OSMesaGetProcAddress; }
  const char* name() const override { return "OSMesa"; }

 private:
  OSMesaContext context_;
  std::vector<unsigned char> window_;
};

/// Returns false if GALLIUM_DRIVER names a driver that OSMesa does not have. Mesa 22 then ends the
/// program.
bool has_driver() {
  const char* const name = std::getenv("GALLIUM_DRIVER");
  return name == nullptr || std::string_view(name) == "llvmpipe" ||
         std::string_view(name) == "softpipe";
}

}  // namespace

std::unique_ptr<GlContext> make_osmesa_context(std::string& tried) {
  if (!has_driver()) {
    tried += "OSMesa: it has no driver of the name in GALLIUM_DRIVER; ";
    return nullptr;
  }
  constexpr std::array<std::array<int, 2>, 2> kVersions = {{{4, 5}, {3, 3}}};
  for (const auto& [major, minor] : kVersions) {
    const std::array<int, 11> attributes = {OSMESA_FORMAT,
                                            OSMESA_RGBA,
                                            OSMESA_PROFILE,
                                            OSMESA_CORE_PROFILE,
                                            OSMESA_CONTEXT_MAJOR_VERSION,
                                            major,
                                            OSMESA_CONTEXT_MINOR_VERSION,
                                            minor,
                                            OSMESA_DEPTH_BITS,
                                            24,
                                            0};
    const OSMesaContext context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
    if (context == nullptr) continue;
    auto owned = std::make_unique<OsmesaContext>(context);
    if (owned->try_make_current()) return owned;
  }
  tried += "OSMesa: no 4.5 or 3.3 core context; ";
  return nullptr;
}

}  // namespace runstone
