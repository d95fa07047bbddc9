// LightCode: what a material does to light, in 16 bits: whether light passes its voxels, and the
// light that it gives off. Pure.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

enum class LightPass : std::uint8_t {
  open = 0,    // air and glass
  liquid = 1,  // light loses a little in each voxel
  leaves = 2,  // light loses more
  opaque = 3,
};

/// Bits 0 to 11 are the emission: red, green and blue with 4 bits each. Bits 12 and 13 are the
/// LightPass. The code 0 is that of air.
using LightCode = std::uint16_t;

constexpr LightCode light_code(LightPass pass, unsigned red, unsigned green, unsigned blue) {
  return static_cast<LightCode>(static_cast<unsigned>(pass) << 12 | blue << 8 | green << 4 | red);
}
constexpr LightPass pass_of(LightCode code) { return static_cast<LightPass>(code >> 12 & 3U); }
/// Returns the emission: the square root of the linear brightness, 0 .. 15. `channel` is 0 for red,
/// 1 for green and 2 for blue.
constexpr unsigned emission_of(LightCode code, unsigned channel) {
  return code >> (4 * channel) & 15U;
}

/// Codes by material id. Ids beyond the end are opaque, as for the mesher.
using LightCodes = std::vector<LightCode>;

LightCode light_code(const MaterialInfo& material);
LightCodes light_codes(const MaterialTable& materials);

}  // namespace runstone
