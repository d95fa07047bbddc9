// Luanti's blocks as its server sends them (serialisation version 29), byte for byte, as a form to
// compare with. One zstd stream of level 3 without a content size holds
//   flags u8 | lighting u16 | content width 2 | parameter width 2 | 4096 ids as big-endian u16
//   | 4096 param1 | 4096 param2 | metadata u8 0
// and one byte follows the stream. Rows of map.sqlite have a version byte before the stream and,
// inside it, a timestamp and a table of names, which the wire does not have. Source: Luanti's
// doc/world_format.md and mapblock.cpp.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

inline constexpr std::size_t kLuantiNodes = 4096;

/// 16^3 nodes, x fastest, then y, then z.
struct LuantiNodes {
  std::array<std::uint16_t, kLuantiNodes> id{};
  // Light: low nibble by day, high nibble at night.
  std::array<std::uint8_t, kLuantiNodes> param1{};
  std::array<std::uint8_t, kLuantiNodes> param2{};
  friend bool operator==(const LuantiNodes&, const LuantiNodes&) = default;
};

/// Appends the bytes of one block on the wire. Thread: uses scratch and context of the calling
/// thread.
void encode_luanti_block(const LuantiNodes& nodes, Bytes& out);

/// Decodes the output of encode_luanti_block().
Result<void> decode_luanti_wire(ByteView block, LuantiNodes& out);
/// Decodes a row of map.sqlite. Ids are those of the row; names are skipped.
Result<void> decode_luanti_row(ByteView row, LuantiNodes& out);

}  // namespace runstone::bench
