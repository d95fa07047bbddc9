// RlogBlock: the header of every block of an .rlog file, and the bounds of the format. An .rlog is
// the edit log as one stream: file mark, then blocks of the kinds world, players, edits, end. Each
// header names the edits of its block and its length, so a reader advances from header to header
// without unpacking. Header checksums are chained: a reader detects a block that was cut out, moved
// or taken from another file. docs/edit-log.md gives the bytes.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// The first bytes of every .rlog. The bytes before and after the name change if a program
/// transfers the file as text.
inline constexpr std::array<std::uint8_t, 8> kRlogMark = {0x89, 'R',  'L',  'O',
                                                          'G',  '\r', '\n', 0x1a};
inline constexpr std::uint32_t kRlogVersion = 1;
inline constexpr std::size_t kRlogFileHeadBytes = 12;  // mark and version
inline constexpr std::size_t kRlogHeaderBytes = 64;
/// The maximum sizes of one block. They also bound a reader's memory.
inline constexpr std::uint32_t kRlogRawBytesMax = std::uint32_t{1} << 22;
inline constexpr std::uint32_t kRlogCountMax = std::uint32_t{1} << 16;
/// The greatest value of a field that is a 32-bit number in memory and a varint in the file.
inline constexpr std::uint64_t kRlogU32Max = std::numeric_limits<std::uint32_t>::max();

/// The kind of a block. The values are stored.
enum class RlogKind : std::uint32_t { world = 1, players = 2, edits = 3, end = 4 };

struct RlogBlock {
  RlogKind kind = RlogKind::end;
  // Bytes of the payload in the file. Fewer than raw_bytes: the payload is one zstd frame.
  std::uint32_t stored_bytes = 0;
  std::uint32_t raw_bytes = 0;  // of the payload unpacked
  std::uint32_t count = 0;      // edits or players
  Sequence first = 1;           // of the first edit in or behind this block
  TimeUs first_us = 0;          // UTC, of its first edit; without edits, of the edit before it
  TimeUs last_us = 0;           // of its last edit; without edits, as first_us
  std::uint64_t position = 0;   // of this header in the file
  std::uint64_t payload_checksum = 0;  // XXH3-64 of the stored payload
  // XXH3-64 of the rest of the header, seeded with that of the previous block.
  std::uint64_t header_checksum = 0;
  friend bool operator==(const RlogBlock&, const RlogBlock&) = default;
};

/// An error in an .rlog and its place. Everything before `seq` is valid.
struct RlogError {
  Error error;                  // its offset is a byte of the unpacked payload, if that is wrong
  Sequence seq = 0;             // first edit that cannot be read
  std::uint64_t position = 0;   // byte of the file where the block begins
  std::string message() const;  // one line: "edit 9121 at byte 123456: WHAT"
};
template <class T>
using RlogResult = Result<T, RlogError>;

/// Fills in the header checksum, given that of the previous block (0 for the first one), and
/// appends the header.
void write_header(RlogBlock& block, std::uint64_t checksum_before, Bytes& out);
/// Reads a header. Checks the checksum and the bounds of each field, but not the sequence of
/// blocks.
Result<RlogBlock> read_header(ByteView in, std::uint64_t checksum_before);

std::uint64_t rlog_payload_checksum(ByteView stored);

/// Replaces `out` by the payload as one zstd frame, or by the payload itself if the frame is not
/// smaller or `level` is 0.
void pack_rlog_payload(ByteView raw, int level, Bytes& out);
/// Unpacks a stored payload. Requires stored.size() <= raw_bytes. The output of an untrusted frame
/// is bounded by `raw_bytes`.
Result<void> unpack_rlog_payload(ByteView stored, std::uint32_t raw_bytes, Bytes& out);

}  // namespace runstone
