// RsbBlock: the header of every block of an .rsb file, and the bounds of the format. An .rsb is one
// build as a stream: file mark, then blocks of the kinds head, materials, sections, end. Each
// header names the entries of its block and its length, so a reader advances from header to header
// without unpacking. Header checksums are chained: a reader detects a block that was cut out, moved
// or taken from another file. docs/builds.md gives the bytes.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// The first bytes of every .rsb. The bytes before and after the name change if a program transfers
/// the file as text.
inline constexpr std::array<std::uint8_t, 8> kRsbMark = {0x89, 'R',  'S',  'B',
                                                         'F',  '\r', '\n', 0x1a};
/// The version of a file whose materials are cubes, and that of a file in which one has a shape.
inline constexpr std::uint32_t kRsbVersion = 1, kRsbVersionOfShapes = 2;
inline constexpr std::size_t kRsbFileHeadBytes = 12;  // mark and version
inline constexpr std::size_t kRsbHeaderBytes = 48;
/// The maximum sizes of one block. They also bound a reader's memory.
inline constexpr std::uint32_t kRsbRawBytesMax = std::uint32_t{1} << 22;
inline constexpr std::uint32_t kRsbCountMax = std::uint32_t{1} << 16;
/// The maximum size of all names, states and colours of a build, unpacked. Real builds have some
/// kilobytes.
inline constexpr std::uint64_t kRsbMaterialBytesMax = std::uint64_t{8} << 20;

/// The kind of a block. The values are stored.
enum class RsbKind : std::uint32_t { head = 1, materials = 2, sections = 3, end = 4 };

struct RsbBlock {
  RsbKind kind = RsbKind::end;
  // Bytes of the payload in the file. Fewer than raw_bytes: the payload is one zstd frame.
  std::uint32_t stored_bytes = 0;
  std::uint32_t raw_bytes = 0;         // of the payload unpacked
  std::uint32_t count = 0;             // materials or sections
  std::uint64_t first = 0;             // index of the first material, number of the first section
  std::uint64_t position = 0;          // of this header in the file
  std::uint64_t payload_checksum = 0;  // XXH3-64 of the stored payload
  // XXH3-64 of the rest of the header, seeded with that of the previous block.
  std::uint64_t header_checksum = 0;
  friend bool operator==(const RsbBlock&, const RsbBlock&) = default;
};

/// An error in an .rsb and its place.
struct RsbError {
  Error error;                  // its offset is a byte of the unpacked payload, if that is wrong
  const char* part = "mark";    // the kind of the block: "head", "materials", "sections" or "end"
  std::uint64_t position = 0;   // byte of the file where the block begins
  std::string message() const;  // one line: "sections at byte 123456: WHAT"
};
template <class T>
using RsbResult = Result<T, RsbError>;

/// Reads up to out.size() bytes of the file at `position` and returns their number, which is
/// smaller only at the end of the file. Returns nullopt if the file cannot be read.
using RsbSource =
    std::function<std::optional<std::size_t>(std::uint64_t position, std::span<std::uint8_t> out)>;
/// Takes the next bytes of the file. Returns false if they cannot be written, which ends the
/// writing.
using RsbSink = std::function<bool(ByteView)>;

/// Returns a source over bytes, which must outlive it.
RsbSource rsb_source(ByteView file);

/// Returns the name of a kind, or "block" for an unknown one.
const char* rsb_part_name(RsbKind kind);

/// Fills in the header checksum, given that of the previous block (0 for the first one), and
/// appends the header.
void write_rsb_header(RsbBlock& block, std::uint64_t checksum_before, Bytes& out);
/// Reads a header. Checks the checksum and the bounds of each field, but not the sequence of
/// blocks.
Result<RsbBlock> read_rsb_header(ByteView in, std::uint64_t checksum_before);

std::uint64_t rsb_payload_checksum(ByteView stored);

/// Replaces `out` by the payload as one zstd frame, or by the payload itself if the frame is not
/// smaller or `level` is 0.
void pack_rsb_payload(ByteView raw, int level, Bytes& out);
/// Unpacks a stored payload. Requires stored.size() <= raw_bytes. The output of an untrusted frame
/// is bounded by `raw_bytes`.
Result<void> unpack_rsb_payload(ByteView stored, std::uint32_t raw_bytes, Bytes& out);

}  // namespace runstone
