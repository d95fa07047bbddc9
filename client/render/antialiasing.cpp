#include "client/render/antialiasing.hpp"

#include <algorithm>
#include <array>

namespace runstone {

Antialiasing usable(Antialiasing wanted, Quality quality, const AntialiasingMeans& means) {
  const bool has_msaa = means.samples_max >= 2;
  switch (wanted) {
    case Antialiasing::automatic:
      return has_msaa && !means.is_software && quality != Quality::low ? Antialiasing::msaa
                                                                       : Antialiasing::off;
    case Antialiasing::msaa:
      return has_msaa ? Antialiasing::msaa : Antialiasing::fxaa;
    case Antialiasing::off:
    case Antialiasing::fxaa:
      break;
  }
  return wanted;
}

bool is_software_renderer(std::string_view name) {
  constexpr std::array<std::string_view, 6> kNames = {
      "llvmpipe", "softpipe", "swrast", "SwiftShader", "Software", "Microsoft Basic Render"};
  return std::any_of(kNames.begin(), kNames.end(), [name](std::string_view part) {
    return name.find(part) != std::string_view::npos;
  });
}

const char* to_string(Antialiasing antialiasing) {
  switch (antialiasing) {
    case Antialiasing::automatic:
      return "auto";
    case Antialiasing::off:
      return "off";
    case Antialiasing::fxaa:
      return "fxaa";
    case Antialiasing::msaa:
      return "msaa";
  }
  return "unknown";
}

std::optional<Antialiasing> parse_antialiasing(std::string_view name) {
  const auto* const found =
      std::find_if(kAntialiasings.begin(), kAntialiasings.end(),
                   [name](Antialiasing antialiasing) { return name == to_string(antialiasing); });
  if (found == kAntialiasings.end()) return std::nullopt;
  return *found;
}

}  // namespace runstone
