// Minecraft's sections as its server sends them (1.16 to 1.21.4), byte for byte, as a form to
// compare with. Each 16^3 section: u16 voxels that are not air | bits u8 | palette | varint longs |
// longs, big-endian
//   bits 0: one material, a varint; no longs
//   bits 4 .. 8: varint size and varints of the palette in order of appearance; indices, low bits
//   first, none across two longs
//   bits 15: no palette, ids themselves
// The sections of one chunk lie one after another in one zlib stream of level 6, as in the game.
// Biomes and light are left out. Source: wiki.vg, "Chunk Format".
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// 16^3 voxels, x fastest, then z, then y.
using PaletteSection = std::array<Material, 4096>;

/// Appends one stream. Requires ids below 2^15. Thread: uses scratch of the calling thread.
void encode_palette_sections(std::span<const PaletteSection> sections, Bytes& out);

/// Decodes as many sections as `out` has room for. Fails if bytes follow them.
Result<void> decode_palette_sections(ByteView stream, std::span<PaletteSection> out);

}  // namespace runstone::bench
