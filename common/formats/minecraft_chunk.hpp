// A chunk of Minecraft, decompressed: where its sections lie in the bytes. Internal to the reader of
// regions.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"
#include "common/formats/nbt_reader.hpp"

namespace runstone {

inline constexpr std::uint32_t kSectionVoxels = 16 * 16 * 16;

/// A section that has blocks. The views point into the chunk.
struct MinecraftSection {
  std::int32_t y = 0;  // in sections
  bool has_y = false;
  // From 1.13: offset of the palette, the head of a list; 0: none.
  std::size_t palette_at = 0;
  std::optional<NbtLongs> states;
  // To 1.12.
  ByteView blocks, data, add;

  bool has_blocks() const { return palette_at != 0 || !blocks.empty(); }
};

struct MinecraftChunk {
  std::optional<std::int32_t> x, z;        // in chunks
  std::int64_t version = 0;                // DataVersion; 0 before 1.9
  bool has_level = false;                  // the sections lie in a compound "Level", as before 1.18
  std::vector<MinecraftSection> sections;  // those that have blocks, ascending by y
};

/// Finds the parts of a chunk, which may stand in any order. Fails if a part is bad: a length, a
/// section that occurs twice, a y outside -128 .. 127. The offset of an error is a byte of `plain`.
/// Cost: O(bytes).
Result<void> scan_minecraft_chunk(ByteView plain, MinecraftChunk& out);

/// Reads an entry of a palette: a compound with "Name" and "Properties". The states are ascending by
/// key.
ForeignBlock read_palette_block(NbtReader& in);

/// Returns the bits of one value of a section, from the number of longs. Sets `crossing` to true if
/// values cross from long to long. Returns 0 if no layout has that many longs. Requires a palette that
/// is not empty.
unsigned section_bits(std::size_t palette_size, std::size_t longs, std::int64_t version,
                      bool& crossing);

}  // namespace runstone
