#include "common/formats/litematic_reader.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "common/core/build_info.hpp"
#include "common/formats/grid_pieces.hpp"
#include "common/formats/nbt_file.hpp"
#include "common/formats/schematic_names.hpp"
#include "common/formats/schematic_palette.hpp"

namespace runstone {
namespace {

constexpr std::int64_t kLitematicVersionMax = 7;
constexpr std::size_t kRegionsMax = 4096;
constexpr unsigned kNumberBitsMin = 2;
constexpr std::int64_t kTimeMsMax = kBuildTimeMax / 1000;

struct LitematicRegion {
  VoxelPos position, size;  // a negative side reaches from the position downwards
  bool has_position = false, has_size = false;
  SchematicPalette palette;
  NbtArrayPlace cells;
};

struct LitematicHead {
  std::int64_t version = 0;
  std::string name, author;
  std::int64_t time_ms = 0;
  std::vector<LitematicRegion> regions;
  std::size_t name_bytes_left = kSchematicNameBytesMax;
};

class LitematicHeadReader {
 public:
  LitematicHeadReader(NbtReader& in, LitematicHead& head) : in_(in), head_(head) {}

  void read() {
    in_.root();
    NbtEntry entry;
    while (in_.next(entry)) {
      if (entry.name == "Version")
        head_.version = in_.integer(entry.type, "litematic: Version is no integer");
      else if (entry.is("Metadata", NbtType::compound))
        read_metadata();
      else if (entry.is("Regions", NbtType::compound))
        read_regions();
      else
        in_.skip(entry.type);
    }
  }

 private:
  void read_metadata() {
    NbtEntry entry;
    while (in_.next(entry)) {
      if (entry.is("Name", NbtType::string))
        head_.name = from_modified_utf8(in_.string());
      else if (entry.is("Author", NbtType::string))
        head_.author = from_modified_utf8(in_.string());
      else if (entry.is("TimeCreated", NbtType::i64))
        head_.time_ms = in_.i64();
      else
        in_.skip(entry.type);
    }
  }

  void read_regions() {
    NbtEntry entry;
    while (in_.next(entry)) {
      if (entry.type != NbtType::compound) {
        in_.skip(entry.type);
        continue;
      }
      if (head_.regions.size() == kRegionsMax) {
        in_.reject(ErrorCode::limit_exceeded, "litematic: more than 4096 regions");
        return;
      }
      head_.regions.emplace_back();
      read_region(head_.regions.back());
    }
  }

  void read_region(LitematicRegion& region) {
    NbtEntry entry;
    while (in_.next(entry)) {
      if (entry.is("Position", NbtType::compound)) {
        region.has_position = true;
        read_place(region.position);
      } else if (entry.is("Size", NbtType::compound)) {
        region.has_size = true;
        read_place(region.size);
      } else if (entry.is("BlockStatePalette", NbtType::list)) {
        read_litematic_palette(region.palette);
      } else if (entry.is("BlockStates", NbtType::long_array)) {
        region.cells = skip_nbt_array(in_, 8);
      } else {
        in_.skip(entry.type);
      }
    }
  }

  void read_place(VoxelPos& place) {
    NbtEntry entry;
    while (in_.next(entry)) {
      if (entry.is("x", NbtType::i32))
        place.x = in_.i32();
      else if (entry.is("y", NbtType::i32))
        place.y = in_.i32();
      else if (entry.is("z", NbtType::i32))
        place.z = in_.i32();
      else
        in_.skip(entry.type);
    }
  }

  void read_litematic_palette(SchematicPalette& palette) {
    const NbtList list = in_.list();
    if (list.count > 0 && list.type != NbtType::compound)
      in_.reject(ErrorCode::bad_value, "litematic: BlockStatePalette is no list of compounds");
    for (std::uint32_t i = 0; i < list.count && in_.ok(); ++i) {
      const BlockState state = read_state();
      if (!in_.ok()) return;
      const auto added =
          palette.add(std::int64_t{i}, state.name, block_of_schematic(state.name, state.properties),
                      head_.name_bytes_left);
      if (!added) in_.reject(added.error().code, added.error().what);
    }
  }

  struct BlockState {
    std::string name;
    std::vector<BlockProperty> properties;
  };
  BlockState read_state() {
    BlockState state;
    NbtEntry entry;
    while (in_.next(entry)) {
      if (entry.is("Name", NbtType::string))
        state.name = in_.string();
      else if (entry.is("Properties", NbtType::compound))
        read_properties(state);
      else
        in_.skip(entry.type);
    }
    return state;
  }

  void read_properties(BlockState& state) {
    std::size_t bytes = 0;
    NbtEntry entry;
    while (in_.next(entry)) {
      if (entry.type != NbtType::string) {
        in_.skip(entry.type);
        continue;
      }
      std::string key(entry.name);
      std::string value(in_.string());
      bytes += sizeof(BlockProperty) + key.size() + value.size();
      if (bytes > head_.name_bytes_left) {
        in_.reject(ErrorCode::limit_exceeded,
                   "litematic: the names and states of the blocks take more than 24 MiB");
        return;
      }
      state.properties.emplace_back(std::move(key), std::move(value));
    }
  }

  NbtReader& in_;
  LitematicHead& head_;
};

unsigned number_bits(const LitematicRegion& region) {
  return std::max(kNumberBitsMin, static_cast<unsigned>(std::bit_width(region.palette.size() - 1)));
}

std::uint64_t cells_of(const VoxelBox& box) {
  const auto side = [](std::int32_t low, std::int32_t high) {
    return static_cast<std::uint64_t>(high - low);
  };
  return side(box.min.x, box.max.x) * side(box.min.y, box.max.y) * side(box.min.z, box.max.z);
}

/// Returns the box of a region, or an error if its bytes are not those of such a box.
Result<VoxelBox> box_of_region(const LitematicRegion& region, std::uint64_t volume_left) {
  if (!region.has_position || !region.has_size)
    return fail(ErrorCode::bad_value, "litematic: a region has no Position or no Size");
  VoxelBox box;
  std::uint64_t volume = 1;
  const auto set = [&](std::int32_t VoxelPos::* axis) {
    const std::int64_t size = region.size.*axis, side = size < 0 ? -size : size;
    const std::int64_t low = std::int64_t{region.position.*axis} + (size < 0 ? size + 1 : 0);
    if (side < 1 || side > kBuildSideMax) return false;
    if (low < -kWorldLimit || low + side > kWorldLimit) return false;
    box.min.*axis = static_cast<std::int32_t>(low);
    box.max.*axis = static_cast<std::int32_t>(low + side);
    volume *= static_cast<std::uint64_t>(side);
    return true;
  };
  if (!set(&VoxelPos::x) || !set(&VoxelPos::y) || !set(&VoxelPos::z)) {
    return fail(ErrorCode::bad_value,
                "litematic: a side of a region is not 1 .. 1048576, or reaches out of the world");
  }
  if (volume > volume_left)
    return fail(ErrorCode::limit_exceeded, "litematic: more than 2147483647 cells");
  if (region.palette.size() == 0)
    return fail(ErrorCode::bad_value, "litematic: a region has no BlockStatePalette");
  if (region.cells.bytes != (volume * number_bits(region) + 63) / 64 * 8) {
    return fail(ErrorCode::bad_value,
                "litematic: BlockStates has another length than Size and palette say");
  }
  return box;
}

/// Takes numbers of `bits` bits from longs, the lowest bits first. A number may begin in one long and
/// end in the next.
class PackedNumbers {
 public:
  PackedNumbers(NbtArrayCursor& in, unsigned bits)
      : in_(in), bits_(bits), mask_((std::uint64_t{1} << bits) - 1) {}

  std::uint32_t next() {
    std::uint64_t number = rest_;
    if (rest_bits_ >= bits_) {
      rest_ >>= bits_;
      rest_bits_ -= bits_;
    } else {
      const std::uint64_t more = next_long();
      number |= more << rest_bits_;
      rest_ = more >> (bits_ - rest_bits_);
      rest_bits_ += 64 - bits_;
    }
    return static_cast<std::uint32_t>(number & mask_);
  }

 private:
  std::uint64_t next_long() {
    if (in_.has_more() && in_.part().size() >= 8) {
      const std::uint64_t v = big_endian_at<std::uint64_t>(in_.part().data());
      in_.advance(8);
      return v;
    }
    std::uint64_t v = 0;
    for (int i = 0; i < 8; ++i) v = v << 8 | in_.u8();
    return v;
  }
  NbtArrayCursor& in_;
  unsigned bits_;
  std::uint64_t mask_, rest_ = 0;
  unsigned rest_bits_ = 0;
};

Result<void> read_region_cells(NbtArrayCursor& in, const LitematicRegion& region,
                               const VoxelBox& box, const PieceSink& sink) {
  in.go_to(region.cells);
  GridPieces rows(box, AxisOrder::xzy, region.palette.blocks(), sink);
  PackedNumbers numbers(in, number_bits(region));
  std::uint64_t left = rows.left();
  std::uint32_t number = numbers.next();
  while (left > 0) {
    std::uint64_t count = 1;
    std::uint32_t next = number;
    while (count < left && (next = numbers.next()) == number) ++count;
    if (!in.reader().ok()) return failure(in.reader().error());
    const auto material = region.palette.find(number);
    if (!material) {
      return fail(ErrorCode::bad_value, "litematic: the palette has no block for a cell's number",
                  in.offset());
    }
    if (const auto appended = rows.append(count, *material); !appended) return appended;
    left -= count;
    number = next;
  }
  return {};
}

}  // namespace

Result<ForeignInfo> read_litematic(ByteView file, const PieceSink& sink) {
  LitematicHead head;
  {
    NbtFileSource source(file);
    NbtReader in(source);
    LitematicHeadReader(in, head).read();
    if (!in.ok()) return failure(in.error());
  }
  if (head.version < 1 || head.version > kLitematicVersionMax)
    return fail(ErrorCode::bad_version, "litematic: Version is missing or not 1 .. 7");
  if (head.regions.empty()) return fail(ErrorCode::bad_value, "litematic: there are no Regions");
  // Every region is checked before the first piece is given.
  std::vector<VoxelBox> boxes;
  std::uint64_t volume_left = kGridVolumeMax;
  for (const LitematicRegion& region : head.regions) {
    const auto box = box_of_region(region, volume_left);
    if (!box) return failure(box.error());
    volume_left -= cells_of(*box);
    boxes.push_back(*box);
  }
  // The arrays lie in the file in the order of the regions, so one pass reads them all.
  NbtArrayCursor in(file, {});
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto read = read_region_cells(in, head.regions[i], boxes[i], sink);
    if (!read) return failure(read.error());
  }
  ForeignInfo info;
  info.name = std::move(head.name);
  info.author = std::move(head.author);
  if (head.time_ms > 0 && head.time_ms <= kTimeMsMax) info.created_us = head.time_ms * 1000;
  return info;
}

}  // namespace runstone
