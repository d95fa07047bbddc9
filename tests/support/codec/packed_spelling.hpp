// A writer of packed chunk bytes, field by field as docs/protocol.md lists them. It can also write
// invalid bytes that an honest encoder never writes. It shares no code with the codec.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/bytes.hpp"

namespace runstone::test {

/// Appends a varint, in the shortest form or with `extra` more bytes.
inline void spell_varint(Bytes& out, std::uint64_t v, int extra = 0) {
  while (v >= 128) {
    out.push_back(static_cast<std::uint8_t>(128 + v % 128));
    v /= 128;
  }
  if (extra == 0) {
    out.push_back(static_cast<std::uint8_t>(v));
    return;
  }
  out.push_back(static_cast<std::uint8_t>(128 + v));
  for (int i = 1; i < extra; ++i) out.push_back(128);
  out.push_back(0);
}

/// Returns one zstd frame without its magic number. `announce` says whether it contains its content
/// size.
Bytes zstd_frame(ByteView body, bool announce = true);

/// The default is a chunk of 8x8x8 with three runs of 3, 197 and 312 voxels of materials 1, 0 and
/// 300.
struct PackedSpelling {
  PackedSpelling();
  std::uint8_t encoding = 2, version = 1, order = 2;
  std::array<std::uint8_t, 3> sides{8, 8, 8};
  std::uint64_t runs = 3;
  std::vector<std::uint64_t> palette;         // first id, then differences - 1
  std::optional<std::uint64_t> palette_size;  // if it differs from palette.size()
  Bytes body;
  std::optional<Bytes> stored;  // instead of the body, for example a zstd frame

  Bytes bytes() const;
};

}  // namespace runstone::test
