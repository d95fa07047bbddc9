// RlogBlock: what stands before every block of an .rlog file, and the bounds of the format. An .rlog is the
// edit log as one stream: file mark, then blocks: world, players, edits, end. Each header says which edits
// the block holds and how long it is, so a reader hops from header to header without unpacking anything.
// Header checksums are chained: a block that was cut out, moved or taken from another file is seen.
// docs/edit-log.md gives the bytes.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Stands at the start of every .rlog; the bytes around the name break when a file was sent as text.
inline constexpr std::array<std::uint8_t, 8> kRlogMark = {0x89, 'R',  'L',  'O',
                                                          'G',  '\r', '\n', 0x1a};
inline constexpr std::uint32_t kRlogVersion = 1;
inline constexpr std::size_t kRlogFileHeadBytes = 12;  // mark and version
inline constexpr std::size_t kRlogHeaderBytes = 64;
/// Bounds of one block: what a reader may have to hold.
inline constexpr std::uint32_t kRlogRawBytesMax = std::uint32_t{1} << 22;
inline constexpr std::uint32_t kRlogCountMax = std::uint32_t{1} << 16;

/// Stored.
enum class RlogKind : std::uint32_t { world = 1, players = 2, edits = 3, end = 4 };

struct RlogBlock {
  RlogKind kind = RlogKind::end;
  std::uint32_t stored_bytes =
      0;                        // of the payload in the file; fewer than raw_bytes: one zstd frame
  std::uint32_t raw_bytes = 0;  // of the payload unpacked
  std::uint32_t count = 0;      // edits or players
  Sequence first = 1;           // of the first edit in or behind this block
  TimeUs first_us = 0;  // UTC, of the first edit in it; where it has none, of the edit before it
  TimeUs last_us = 0;   // of the last one
  std::uint64_t position = 0;          // of this header in the file
  std::uint64_t payload_checksum = 0;  // XXH3-64 of the stored payload
  std::uint64_t header_checksum =
      0;  // XXH3-64 of the rest of the header, seeded with that of the block before
  friend bool operator==(const RlogBlock&, const RlogBlock&) = default;
};

/// What is wrong with an .rlog, and where. Everything before `seq` stands.
struct RlogError {
  Error error;       // its offset is a byte of the unpacked payload, where that is what is wrong
  Sequence seq = 0;  // first edit that cannot be had
  std::uint64_t position = 0;   // byte of the file where the block begins
  std::string message() const;  // one line: "edit 9121 at byte 123456: WHAT"
};
template <class T>
using RlogResult = Result<T, RlogError>;

/// Fills in the header checksum, given that of the block before (0 for the first one), and appends the header.
void write_header(RlogBlock& block, std::uint64_t checksum_before, Bytes& out);
/// The reverse; checks the checksum and the bounds of each field, not what the block continues.
Result<RlogBlock> read_header(ByteView in, std::uint64_t checksum_before);

std::uint64_t rlog_payload_checksum(ByteView stored);

/// The payload as one zstd frame; as it is where that is no smaller, or where `level` is 0. `out` is replaced.
void pack_rlog_payload(ByteView raw, int level, Bytes& out);
/// The reverse of a stored payload of sound length. Hostile frames are bounded by `raw_bytes`.
Result<void> unpack_rlog_payload(ByteView stored, std::uint32_t raw_bytes, Bytes& out);

}  // namespace runstone
