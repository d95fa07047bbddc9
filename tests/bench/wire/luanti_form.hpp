// Luanti's blocks as its server sends them (serialisation version 29): to be compared with, so exactly its
// bytes. One zstd stream without a content size, level 3, of
//   flags u8 | lighting u16 | content width 2 | parameter width 2 | 4096 ids as big-endian u16 | 4096 param1
//   | 4096 param2 | metadata u8 0
// and one byte behind the stream. Rows of map.sqlite have a version byte before it and, inside, a timestamp
// and a table of names, which the wire does without. Source: Luanti's doc/world_format.md and mapblock.cpp.
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
  std::array<std::uint8_t, kLuantiNodes>
      param1{};  // light: low nibble by day, high nibble at night
  std::array<std::uint8_t, kLuantiNodes> param2{};
  friend bool operator==(const LuantiNodes&, const LuantiNodes&) = default;
};

/// Appends the bytes of one block on the wire. Scratch and context are the thread's.
void encode_luanti_block(const LuantiNodes& nodes, Bytes& out);

/// What encode_luanti_block() wrote.
Result<void> decode_luanti_wire(ByteView block, LuantiNodes& out);
/// A row of map.sqlite. Ids are the row's own; names are skipped.
Result<void> decode_luanti_row(ByteView row, LuantiNodes& out);

}  // namespace runstone::bench
