// A writer of Luanti map blocks for tests, made from the published format. It shares no code with
// the decoder.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/core/bytes.hpp"

namespace runstone::test {

/// The content of a block before compression. Every field can be set wrong.
struct LuantiBlockFields {
  std::uint8_t name_table_version = 0;
  std::vector<std::pair<std::uint16_t, std::string>> names;
  std::uint8_t content_width = 2, params_width = 2;
  std::vector<std::uint16_t> nodes = std::vector<std::uint16_t>(4096);  // z * 256 + y * 16 + x
  Bytes param2 = Bytes(4096);                                           // in the same order
  Bytes rest = {0, 0, 0, 0, 0, 10, 0, 0};  // empty metadata, objects and timers
};

/// Returns the bytes inside the stream.
Bytes luanti_plain(const LuantiBlockFields& fields);
/// Returns a whole row: version byte and zstd stream, without a content size as in the game.
Bytes luanti_row(const Bytes& plain, std::uint8_t version = 29);
inline Bytes luanti_row(const LuantiBlockFields& fields) {
  return luanti_row(luanti_plain(fields));
}

/// Returns a whole row of a version from 24 to 28: streams of zlib, and the names last. `metadata`
/// is the content of the second stream, and `behind` is what follows the names.
Bytes luanti_old_row(const LuantiBlockFields& fields, std::uint8_t version,
                     const Bytes& metadata = {0}, const Bytes& behind = {10, 0, 0});

/// Reads a row node by node: the name of every node, in node order. It is an oracle for whole
/// worlds. Requires a valid row.
std::vector<std::string> luanti_nodes(ByteView row);
/// Reads the param2 of every node of a row.
Bytes luanti_params(ByteView row);

}  // namespace runstone::test
