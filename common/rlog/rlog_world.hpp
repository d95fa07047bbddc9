// RlogWorld and RlogPlayer: what an .rlog says beside its edits: which world they belong to, what that world
// was before them, and who the authors are. No secrets: the server's key stays in the world.
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
  /// Whether the world holds base chunks that no generator makes (imported, or compacted edits). Edits alone
  /// then do not give the world again: they belong on a copy of it.
  bool has_base = false;
  Version
      head;  // the edit before the first one of the file; (0, 0): the file begins at the beginning
  TimeUs head_us = 0;  // UTC, of that edit
  friend bool operator==(const RlogWorld&, const RlogWorld&) = default;
};

struct RlogPlayer {
  AuthorId author = 0;  // from 1
  std::array<std::uint8_t, 32> key{};
  std::string name;  // last used, at most kRlogNameBytesMax bytes
  friend bool operator==(const RlogPlayer&, const RlogPlayer&) = default;
};

/// Payload of the world block; requires that it fits a block. head.seq + 1 and head_us stand in its header.
Bytes encode_rlog_world(const RlogWorld& world);
/// The reverse, without what stands in the header. The offset of an error is a byte of the payload.
Result<RlogWorld> decode_rlog_world(ByteView in);

void encode_rlog_player(const RlogPlayer& player, Bytes& out);
/// Exactly `count` players with ascending author numbers above `author_before`, appended to `out`.
Result<void> decode_rlog_players(ByteView in, std::uint32_t count, AuthorId author_before,
                                 std::vector<RlogPlayer>& out);

}  // namespace runstone
