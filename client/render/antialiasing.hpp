// Antialiasing: how the edges of a picture are smoothed. Pure.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "client/render/frame_look.hpp"

namespace runstone {

/// All choices, in the order in which they are offered.
inline constexpr std::array kAntialiasings = {Antialiasing::automatic, Antialiasing::off,
                                              Antialiasing::fxaa, Antialiasing::msaa};

/// The samples of a pixel that MSAA takes, if the driver has as many.
inline constexpr int kSamplesWanted = 4;

/// The abilities of a driver that antialiasing depends on.
struct AntialiasingMeans {
  bool is_software = false;  // the processor draws
  int samples_max = 0;       // of a pixel
};

/// Returns how a frame is antialiased: `off`, `fxaa` or `msaa`.
///   - `automatic` is MSAA on a GPU at quality medium and high, and off otherwise, because software
///     drawing pays for each sample.
///   - MSAA needs a driver with two samples a pixel. Without it, FXAA replaces an MSAA that is
///     wanted, and `automatic` is off.
Antialiasing usable(Antialiasing wanted, Quality quality, const AntialiasingMeans& means);

/// Returns true for the names of drivers that draw with the processor, such as "llvmpipe (LLVM
/// 15.0.6, 256 bits)".
bool is_software_renderer(std::string_view name);

/// Returns "auto", "off", "fxaa" or "msaa".
const char* to_string(Antialiasing antialiasing);
/// Returns the antialiasing of that name, or nullopt.
std::optional<Antialiasing> parse_antialiasing(std::string_view name);

}  // namespace runstone
