// A writer of Minecraft's region files for tests. Packing, layouts and streams share no code with the
// reader.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/formats/format.hpp"

namespace runstone::test {

enum class ChunkLayout : std::uint8_t {
  numbers,    // to 1.12: the indices of a section are id * 16 + data
  crossed,    // 1.13 to 1.15
  uncrossed,  // 1.16 and 1.17
  tall,       // from 1.18
};

/// Every field can be set wrong.
struct McSection {
  std::optional<std::int8_t> y;
  std::vector<ForeignBlock> palette;                // not for numbers
  std::vector<std::uint16_t> indices;               // y * 256 + z * 16 + x; empty: no data
  unsigned bits = 0;                                // of an index; 0: what the palette needs
  std::optional<std::size_t> longs = std::nullopt;  // makes the array longer or shorter
};
struct McChunk {
  ChunkLayout layout = ChunkLayout::tall;
  std::optional<std::int32_t> x = 0, z = 0;
  std::optional<std::int32_t> version = std::nullopt;  // if none is given, that of the layout
  std::string status = "full";
  bool version_last = false;
  std::vector<McSection> sections = {};
};

/// Returns the chunk before compression.
Bytes mc_chunk(const McChunk& chunk);

/// Returns the bytes as a stream of lz4-java, in blocks of `block_bytes`.
Bytes lz4_java_stream(const Bytes& plain, std::size_t block_bytes = 65536);

struct McSlot {
  unsigned slot = 0;
  std::uint8_t compression = 2;
  Bytes packed;
};
/// Returns a slot with the chunk compressed: 1 gzip, 2 zlib, 3 none, 4 LZ4.
McSlot mc_slot(unsigned slot, const Bytes& plain, std::uint8_t compression = 2);
/// Returns a region file with the chunks one after the other.
Bytes mc_region(const std::vector<McSlot>& slots);
/// Sets the place of a slot in the header of a region file.
void set_place(Bytes& region, unsigned slot, std::uint32_t sector, std::uint8_t count);

}  // namespace runstone::test
