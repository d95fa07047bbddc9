#include "common/formats/minecraft_region.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "common/core/assert.hpp"
#include "common/formats/deflate.hpp"
#include "common/formats/lz4_block_stream.hpp"
#include "common/formats/minecraft_chunk.hpp"
#include "common/formats/minecraft_sections.hpp"
#include "common/formats/nbt_reader.hpp"

namespace runstone {
namespace {

constexpr std::size_t kSectorBytes = 4096;
constexpr std::size_t kRegionHeadBytes = 2 * kSectorBytes;
constexpr std::uint32_t kRegionHeadSectors = 2;
constexpr std::size_t kChunkHeadBytes = 4 + 1;  // length, compression
constexpr std::uint8_t kExternalFlag = 0x80;
constexpr std::int32_t kRegionMax = kWorldLimit / kMinecraftSection / 32;
// A buffer that a large chunk has grown is given back.
constexpr std::size_t kKeptBufferBytes = std::size_t{4} << 20;

enum class ChunkCompression : std::uint8_t { gzip = 1, zlib = 2, none = 3, lz4 = 4 };

/// Takes a number and the character behind it from a name.
std::optional<std::int32_t> take_number(std::string_view& text, char end) {
  std::int32_t number = 0;
  const auto [at, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const auto length = static_cast<std::size_t>(at - text.data());
  if (error != std::errc{} || length == text.size() || *at != end) return std::nullopt;
  text.remove_prefix(length + 1);
  return number;
}

/// Marks the chunks whose sectors are also those of another chunk, except those that have a fault.
void mark_overlaps(std::array<MinecraftRegion::Slot, kRegionSlots>& slots) {
  std::vector<MinecraftRegion::Slot*> order;
  for (auto& slot : slots) {
    if (slot.first_sector != 0 && slot.fault == nullptr) order.push_back(&slot);
  }
  std::sort(order.begin(), order.end(),
            [](const auto* a, const auto* b) { return a->first_sector < b->first_sector; });
  const auto end_of = [](const MinecraftRegion::Slot& slot) {
    return slot.first_sector + slot.sector_count;
  };
  MinecraftRegion::Slot* furthest = nullptr;
  for (auto* slot : order) {
    if (furthest != nullptr && slot->first_sector < end_of(*furthest)) {
      for (auto* one : {slot, furthest}) {
        if (one->fault == nullptr)
          one->fault = "minecraft region: sectors of a chunk are also those of another one";
      }
    }
    if (furthest == nullptr || end_of(*slot) > end_of(*furthest)) furthest = slot;
  }
}

}  // namespace

std::optional<RegionPos> region_of_file_name(std::string_view path) {
  const std::size_t folder = path.find_last_of("/\\");
  std::string_view name = folder == std::string_view::npos ? path : path.substr(folder + 1);
  if (!name.starts_with("r.")) return std::nullopt;
  name.remove_prefix(2);
  const auto x = take_number(name, '.');
  const auto z = x ? take_number(name, '.') : std::nullopt;
  if (!z || name != "mca") return std::nullopt;
  if (*x < -kRegionMax || *x >= kRegionMax || *z < -kRegionMax || *z >= kRegionMax)
    return std::nullopt;
  return RegionPos{*x, *z};
}

std::string external_chunk_file(RegionPos region, unsigned slot) {
  RUNSTONE_ASSERT(slot < kRegionSlots);
  const auto side = static_cast<std::int32_t>(kRegionSide);
  const std::int32_t x = region.x * side + static_cast<std::int32_t>(slot % kRegionSide);
  const std::int32_t z = region.z * side + static_cast<std::int32_t>(slot / kRegionSide);
  return "c." + std::to_string(x) + "." + std::to_string(z) + ".mcc";
}

Result<MinecraftRegion> open_minecraft_region(ByteView file, std::optional<RegionPos> at) {
  MinecraftRegion region{file, at, {}};
  if (file.empty()) return region;  // the game makes such files
  if (file.size() < kRegionHeadBytes) {
    return fail(ErrorCode::truncated, "minecraft region: file ends inside its header", file.size());
  }
  for (std::size_t i = 0; i < kRegionSlots; ++i) {
    const auto place = big_endian_at<std::uint32_t>(file.data() + 4 * i);
    if (place == 0) continue;
    auto& slot = region.slots[i];
    slot.first_sector = place >> 8;
    slot.sector_count = place & 255;
    slot.saved_s = big_endian_at<std::uint32_t>(file.data() + kSectorBytes + 4 * i);
    if (slot.first_sector < kRegionHeadSectors) {
      slot.fault = "minecraft region: sectors of a chunk lie in the header";
      slot.first_sector = 1;  // the chunk is there
    } else if (slot.sector_count == 0) {
      slot.fault = "minecraft region: a chunk has no sectors";
    } else if (slot.first_sector * kSectorBytes + kChunkHeadBytes > file.size()) {
      slot.fault = "minecraft region: sectors of a chunk lie outside the file";
    }
  }
  mark_overlaps(region.slots);
  return region;
}

struct MinecraftChunkReader::Buffers {
  Bytes plain;
  MinecraftChunk chunk;
  MinecraftPieces pieces;
};

MinecraftChunkReader::MinecraftChunkReader() : buffers_(std::make_unique<Buffers>()) {}
MinecraftChunkReader::~MinecraftChunkReader() = default;
MinecraftChunkReader::MinecraftChunkReader(MinecraftChunkReader&&) noexcept = default;
MinecraftChunkReader& MinecraftChunkReader::operator=(MinecraftChunkReader&&) noexcept = default;

namespace {

struct PackedChunk {
  std::uint8_t compression = 0;
  ByteView bytes;             // inside its file
  std::uint64_t file_at = 0;  // offset of the bytes in their file
};

/// Finds the compressed bytes of a chunk, in the file or outside of it.
Result<PackedChunk> find_chunk(const MinecraftRegion& region, unsigned index,
                               const ExternalChunk& external) {
  const auto& slot = region.slots[index];
  const std::uint64_t at = std::uint64_t{slot.first_sector} * kSectorBytes;
  if (slot.fault != nullptr)
    return fail(ErrorCode::bad_value, slot.fault, std::uint64_t{4} * index);
  const ByteView rest = region.file.subspan(at);  // open_minecraft_region() checked the head
  const auto length = big_endian_at<std::uint32_t>(rest.data());
  const std::uint8_t compression = rest[4];
  if (length == 0) return fail(ErrorCode::bad_value, "minecraft region: a chunk is of 0 bytes", at);
  if (length > slot.sector_count * kSectorBytes - 4) {
    return fail(ErrorCode::bad_value, "minecraft region: a chunk is longer than its sectors", at);
  }
  if (length > rest.size() - 4)
    return fail(ErrorCode::truncated, "minecraft region: file ends inside a chunk", at);
  if ((compression & kExternalFlag) == 0)
    return PackedChunk{compression, rest.subspan(kChunkHeadBytes, length - 1),
                       at + kChunkHeadBytes};
  const auto found = external ? external(index) : std::nullopt;
  if (!found) {
    return fail(ErrorCode::not_found, "minecraft region: the external file of a chunk is missing",
                at + 4);
  }
  return PackedChunk{static_cast<std::uint8_t>(compression & ~kExternalFlag), *found, 0};
}

/// Returns the chunk decompressed: in `buffer`, or where it is if it is not compressed.
Result<ByteView> unpack_chunk(const PackedChunk& packed, Bytes& buffer) {
  const auto moved = [&](Error error) {
    error.offset += packed.file_at;
    return failure(error);
  };
  if (buffer.capacity() > kKeptBufferBytes) buffer = Bytes();
  buffer.clear();
  switch (static_cast<ChunkCompression>(packed.compression)) {
    case ChunkCompression::gzip:
    case ChunkCompression::zlib: {
      const auto end =
          inflate_all(packed.bytes, 0, DeflateForm::zlib_or_gzip, kMinecraftChunkBytesMax, &buffer);
      if (!end) return moved(end.error());
      return ByteView(buffer);
    }
    case ChunkCompression::none:
      if (packed.bytes.size() > kMinecraftChunkBytesMax)
        return moved(
            {ErrorCode::limit_exceeded, "minecraft region: a chunk is larger than 16 MiB", 0});
      return packed.bytes;
    case ChunkCompression::lz4: {
      const auto unpacked = unpack_lz4_blocks(packed.bytes, kMinecraftChunkBytesMax, buffer);
      if (!unpacked) return moved(unpacked.error());
      return ByteView(buffer);
    }
  }
  return moved({ErrorCode::unknown_kind, "minecraft region: unknown compression of a chunk", 0});
}

/// Returns the origin of a chunk. Fails if it is not that of its slot.
Result<VoxelPos> origin_of_chunk(const MinecraftRegion& region, unsigned index,
                                 const MinecraftChunk& chunk) {
  constexpr auto kSide = static_cast<std::int32_t>(kRegionSide);
  if (!chunk.x || !chunk.z)
    return fail(ErrorCode::bad_value, "minecraft chunk: xPos or zPos is missing");
  const std::int32_t x = *chunk.x, z = *chunk.z;
  constexpr std::int32_t kLimit = kWorldLimit / kMinecraftSection;
  if (x < -kLimit || x >= kLimit || z < -kLimit || z >= kLimit)
    return fail(ErrorCode::bad_value, "minecraft chunk: xPos or zPos lies outside a world");
  const RegionPos at{floor_div(x, kSide), floor_div(z, kSide)};
  const std::int32_t slot = x - at.x * kSide + (z - at.z * kSide) * kSide;
  if (slot != static_cast<std::int32_t>(index) || (region.at && at != *region.at)) {
    return fail(ErrorCode::bad_value,
                "minecraft chunk: xPos and zPos are not those of its place in the file");
  }
  return VoxelPos{x * kMinecraftSection, 0, z * kMinecraftSection};
}

}  // namespace

Result<bool> MinecraftChunkReader::read(const MinecraftRegion& region, unsigned slot,
                                        const ExternalChunk& external, const PieceSink& sink) {
  RUNSTONE_ASSERT(slot < kRegionSlots);
  if (region.slots[slot].first_sector == 0) return false;
  const auto packed = find_chunk(region, slot, external);
  if (!packed) return failure(packed.error());
  const auto plain = unpack_chunk(*packed, buffers_->plain);
  if (!plain) return failure(plain.error());
  MinecraftChunk& chunk = buffers_->chunk;
  if (const auto scanned = scan_minecraft_chunk(*plain, chunk); !scanned)
    return failure(scanned.error());
  if (chunk.sections.empty()) return false;
  const auto origin = origin_of_chunk(region, slot, chunk);
  if (!origin) return failure(origin.error());
  const auto given = buffers_->pieces.give(*plain, chunk, *origin, sink);
  if (!given) return failure(given.error());
  return true;
}

Result<void> read_minecraft_region(ByteView file, const PieceSink& sink,
                                   std::vector<RegionFault>& faults) {
  const auto region = open_minecraft_region(file);
  if (!region) return failure(region.error());
  bool sink_failed = false;
  const PieceSink watched = [&](ForeignPiece&& piece) {
    auto taken = sink(std::move(piece));
    sink_failed = !taken;
    return taken;
  };
  MinecraftChunkReader reader;
  for (unsigned slot = 0; slot < kRegionSlots; ++slot) {
    const auto read = reader.read(*region, slot, nullptr, watched);
    if (read) continue;
    if (sink_failed) return failure(read.error());
    faults.push_back({slot, read.error()});
  }
  return {};
}

Result<ForeignInfo> read_minecraft_region(ByteView file, const PieceSink& sink) {
  if (file.empty()) return fail(ErrorCode::truncated, "region: the file is empty");
  std::vector<RegionFault> faults;
  if (const auto read = read_minecraft_region(file, sink, faults); !read)
    return failure(read.error());
  if (!faults.empty()) return failure(faults.front().error);
  return ForeignInfo{};
}

}  // namespace runstone
