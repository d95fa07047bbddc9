// Minecraft Java region files (.mca): 32 x 32 chunks of 16 x 16 columns, each compressed on its own.
//   const auto region = open_minecraft_region(file, region_of_file_name(path));
//   MinecraftChunkReader reader;  // one per thread
//   for (unsigned slot = 0; slot < kRegionSlots; ++slot)
//     reader.read(*region, slot, external, sink);
// Versions 1.2 to 1.21 are read: numbers of blocks (to 1.12), palettes with longs that values cross
// (1.13 to 1.15), palettes with longs that values do not cross (1.16 and 1.17), and sections below 0
// (from 1.18). A chunk that the game has not generated to the end is read as far as it has sections.
// Blocks only: entities, the contents of chests, biomes, light and height maps are not kept.
//
// Every byte is untrusted. A chunk whose sectors overlap those of another one or lie outside the file
// is refused, and so is one that says another place than that of its slot. The other chunks are read.
// Source: the format as it is publicly documented; LZ4 streams as lz4-java writes them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/format.hpp"

namespace runstone {

inline constexpr std::uint32_t kRegionSide = 32;  // in chunks
inline constexpr std::uint32_t kRegionSlots = kRegionSide * kRegionSide;
/// The edge of a section, and the sides of a chunk along x and z.
inline constexpr std::int32_t kMinecraftSection = 16;
/// The maximum size of a chunk, decompressed. Chunks of the game have some 50 KB to 2 MB.
inline constexpr std::size_t kMinecraftChunkBytesMax = std::size_t{16} << 20;
/// The maximum size of the names and states in one piece.
inline constexpr std::size_t kMinecraftNameBytesMax = std::size_t{1} << 20;

/// Place of a region in the grid of regions, as in the name of its file.
struct RegionPos {
  std::int32_t x = 0, z = 0;
  friend bool operator==(const RegionPos&, const RegionPos&) = default;
};

/// Returns the place that a path such as "world/region/r.0.-2.mca" names, or nullopt for another
/// path, or if the region lies outside the coordinates of a world.
std::optional<RegionPos> region_of_file_name(std::string_view path);
/// Returns the name of the file that an external chunk of a region is in: "c.3.-60.mcc". It lies in
/// the folder of the region file. Requires slot < kRegionSlots.
std::string external_chunk_file(RegionPos region, unsigned slot);

/// A region file with its header decoded.
struct MinecraftRegion {
  struct Slot {
    std::uint32_t first_sector = 0;  // of 4096 bytes; 0: the file has no such chunk
    std::uint32_t sector_count = 0;
    std::uint32_t saved_s = 0;    // seconds since 1970
    const char* fault = nullptr;  // why the chunk is refused, or null
  };
  ByteView file;
  std::optional<RegionPos> at;
  std::array<Slot, kRegionSlots> slots;  // x + 32 * z
};

/// Decodes the header of a region file. An empty file has no chunks. If the place is given, chunks
/// that say to lie in another region are refused. Fails with truncated if the file ends inside its
/// header. The file must stay valid as long as the region is used. Cost: O(slots log slots).
Result<MinecraftRegion> open_minecraft_region(ByteView file,
                                              std::optional<RegionPos> at = std::nullopt);

/// Returns the bytes of the external file of a slot (external_chunk_file()), valid until read()
/// returns, or nullopt if there is none. May be null: then external chunks are refused.
using ExternalChunk = std::function<std::optional<ByteView>(unsigned slot)>;

/// Reads chunks. It keeps its buffers from chunk to chunk. Memory: at most 52 MiB, and the
/// runs of one piece. Thread: one reader per thread; readers may share a region.
class MinecraftChunkReader {
 public:
  MinecraftChunkReader();
  ~MinecraftChunkReader();
  MinecraftChunkReader(MinecraftChunkReader&&) noexcept;
  MinecraftChunkReader& operator=(MinecraftChunkReader&&) noexcept;

  /// Gives the pieces of one chunk to the sink, from the lowest to the highest: 16 x 16 columns of
  /// up to 64 voxels, cut at the multiples of 64, in AxisOrder::xzy, with origins in the world. They
  /// reach from the lowest to the highest section that has blocks, and before 1.18 at least from 0
  /// to 255; a section between that is missing is air. Returns false if the file has no such chunk,
  /// or a chunk without a section that has blocks; the sink got nothing then. Fails if the chunk is
  /// refused or bad; the offset of the error is a byte of the file, of the external file, or of what
  /// the chunk decompresses to. Fails with the error of the sink if the sink fails. Unknown numbers
  /// of blocks become "numeric:ID" with the state "data=N". Requires slot < kRegionSlots. Cost:
  /// O(bytes of the chunk, decompressed).
  Result<bool> read(const MinecraftRegion& region, unsigned slot, const ExternalChunk& external,
                    const PieceSink& sink);

 private:
  struct Buffers;
  std::unique_ptr<Buffers> buffers_;
};

/// A chunk that could not be read.
struct RegionFault {
  unsigned slot = 0;
  Error error;
};

/// Reads all chunks of a region file, slot by slot, and appends those that could not be read to
/// `faults`. Fails only if the header is bad, or with the error of the sink.
Result<void> read_minecraft_region(ByteView file, const PieceSink& sink,
                                   std::vector<RegionFault>& faults);
/// Reads all chunks of a region file: the reader of Format. Chunks in external files are refused.
/// After the last chunk it fails with the first error of a chunk, if any.
Result<ForeignInfo> read_minecraft_region(ByteView file, const PieceSink& sink);

}  // namespace runstone
