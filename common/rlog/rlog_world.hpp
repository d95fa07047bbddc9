// RlogWorld and RlogPlayer: the contents of an .rlog besides its edits: the world that the edits
// belong to, its state before them, and their authors. An .rlog has no secrets: the server's key
// stays in the store of the world.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/generate/generator.hpp"

namespace runstone {

inline constexpr std::size_t kRlogNameBytesMax = 1024;

struct RlogWorld {
  std::array<std::uint8_t, 16> world_id{};
  std::uint16_t chunk_edge = 32;  // 16, 32, 64 or 128
  GeneratorPin generator;
  std::string materials;          // TOML (docs/materials.md)
  std::array<double, 3> spawn{};  // x, y, z in voxels
  /// True if the world has base chunks that no generator makes (imported, or compacted edits). Then
  /// the edits alone do not restore the world: they are imported into a copy of it.
  bool has_base = false;
  // The edit before the first one of the file. (0, 0): the file begins with the first edit of the
  // log.
  Version head;
  TimeUs head_us = 0;  // UTC, of that edit
  friend bool operator==(const RlogWorld&, const RlogWorld&) = default;
};

struct RlogPlayer {
  AuthorId author = 0;  // from 1
  std::array<std::uint8_t, 32> key{};
  std::string name;  // the last one used, at most kRlogNameBytesMax bytes
  friend bool operator==(const RlogPlayer&, const RlogPlayer&) = default;
};

/// Returns the payload of the world block. Requires that it fits a block. head.seq + 1 and head_us
/// are in the block's header.
Bytes encode_rlog_world(const RlogWorld& world);
/// Decodes a world block, without the fields of its header. The offset of an error is a byte of the
/// payload.
Result<RlogWorld> decode_rlog_world(ByteView in);

void encode_rlog_player(const RlogPlayer& player, Bytes& out);
/// Decodes exactly `count` players with ascending author numbers above `author_before`, and appends
/// them to `out`.
Result<void> decode_rlog_players(ByteView in, std::uint32_t count, AuthorId author_before,
                                 std::vector<RlogPlayer>& out);

}  // namespace runstone
