#include "common/formats/schematic_reader.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/core/build_info.hpp"
#include "common/formats/grid_pieces.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/nbt_file.hpp"
#include "common/formats/schematic_names.hpp"
#include "common/formats/schematic_palette.hpp"

namespace runstone {
namespace {

constexpr std::int64_t kSpongeVersionMax = 3;
constexpr std::int64_t kSchematicSideMax = 65'535;
constexpr std::int64_t kMillisecondsMax = kBuildTimeMax / 1000;

using IntTriple = std::array<std::int64_t, 3>;

/// Everything of a file but its cells.
struct SchematicHead {
  std::string name, author, materials;
  std::int64_t milliseconds = 0;
  std::optional<std::int64_t> version;
  IntTriple sides{};  // width, height, length: x, y, z
  IntTriple offset{}, origin{};
  bool has_palette = false;
  SchematicPalette palette;
  NbtArrayPlace cells;              // of Sponge: varints
  NbtArrayPlace blocks, data, add;  // of MCEdit: low 8 bits of ids, data, high 4 bits of ids
  bool has_mapping = false;         // as Schematica writes it
  std::map<std::int64_t, std::string> mapping;  // names by id
  std::size_t name_bytes_left = kSchematicNameBytesMax;
};

class SchematicHeadReader {
 public:
  SchematicHeadReader(NbtReader& in, SchematicHead& head) : in_(in), head_(head) {}

  void read() {
    in_.root();
    read_schematic_entries(true);
  }

 private:
  /// In version 3 the schematic is an entry of the outermost compound.
  void read_schematic_entries(bool is_root) {
    NbtEntry entry;
    while (in_.next(entry)) {
      if (is_root && entry.is("Schematic", NbtType::compound))
        read_schematic_entries(false);
      else
        read_schematic_entry(entry);
    }
  }

  void read_schematic_entry(const NbtEntry& entry) {
    constexpr std::array<std::string_view, 3> kSides = {"Width", "Height", "Length"};
    constexpr std::array<std::string_view, 3> kOrigins = {"WEOriginX", "WEOriginY", "WEOriginZ"};
    const auto side = std::find(kSides.begin(), kSides.end(), entry.name);
    const auto origin = std::find(kOrigins.begin(), kOrigins.end(), entry.name);
    if (side != kSides.end()) {
      std::int64_t value = in_.integer(entry.type, "schematic: a side is no integer");
      if (entry.type == NbtType::i16) value &= 0xffff;
      head_.sides[static_cast<std::size_t>(side - kSides.begin())] = value;
    } else if (origin != kOrigins.end()) {
      head_.origin[static_cast<std::size_t>(origin - kOrigins.begin())] =
          in_.integer(entry.type, "schematic: WEOrigin is no integer");
    } else if (entry.name == "Version") {
      head_.version = in_.integer(entry.type, "schematic: Version is no integer");
    } else if (entry.is("Offset", NbtType::int_array)) {
      read_triple(head_.offset);
    } else if (entry.is("Metadata", NbtType::compound)) {
      read_metadata();
    } else if (entry.is("Palette", NbtType::compound)) {
      read_palette();
    } else if (entry.is("BlockData", NbtType::byte_array)) {
      head_.cells = skip_nbt_array(in_, 1);
    } else if (entry.is("Blocks", NbtType::compound)) {
      read_blocks();
    } else if (entry.is("Blocks", NbtType::byte_array)) {
      head_.blocks = skip_nbt_array(in_, 1);
    } else if (entry.is("Data", NbtType::byte_array)) {
      head_.data = skip_nbt_array(in_, 1);
    } else if (entry.is("AddBlocks", NbtType::byte_array)) {
      head_.add = skip_nbt_array(in_, 1);
    } else if (entry.is("Materials", NbtType::string)) {
      head_.materials = in_.string();
    } else if (entry.is("SchematicaMapping", NbtType::compound)) {
      read_mapping();
    } else {
      in_.skip(entry.type);
    }
  }

  void read_blocks() {
    NbtEntry entry;
    while (in_.next(entry)) {
      if (entry.is("Palette", NbtType::compound))
        read_palette();
      else if (entry.is("Data", NbtType::byte_array))
        head_.cells = skip_nbt_array(in_, 1);
      else
        in_.skip(entry.type);
    }
  }

  void read_palette() {
    head_.has_palette = true;
    NbtEntry entry;
    while (in_.next(entry)) {
      const std::string text(entry.name);
      const std::int64_t number =
          in_.integer(entry.type, "schematic: a number of the palette is no integer");
      if (!in_.ok()) return;
      const auto added =
          head_.palette.add(number, text, block_of_schematic_text(text), head_.name_bytes_left);
      if (!added) in_.reject(added.error().code, added.error().what);
    }
  }

  void read_mapping() {
    head_.has_mapping = true;
    NbtEntry entry;
    while (in_.next(entry)) {
      std::string name(entry.name);
      const std::int64_t id = in_.integer(entry.type, "schematic: an id of a block is no integer");
      const std::size_t bytes = 128 + name.size();
      if (bytes > head_.name_bytes_left) {
        in_.reject(ErrorCode::limit_exceeded,
                   "schematic: the names and states of the blocks take more than 24 MiB");
        return;
      }
      head_.name_bytes_left -= bytes;
      head_.mapping.try_emplace(id, std::move(name));
    }
  }

  void read_metadata() {
    NbtEntry entry;
    while (in_.next(entry)) {
      if (entry.is("Name", NbtType::string))
        head_.name = from_modified_utf8(in_.string());
      else if (entry.is("Author", NbtType::string))
        head_.author = from_modified_utf8(in_.string());
      else if (entry.is("Date", NbtType::i64))
        head_.milliseconds = in_.i64();
      else if (entry.is("WorldEdit", NbtType::compound))
        read_world_edit();
      else
        in_.skip(entry.type);
    }
  }

  void read_world_edit() {
    NbtEntry entry;
    while (in_.next(entry)) {
      if (entry.is("Origin", NbtType::int_array))
        read_triple(head_.origin);
      else
        in_.skip(entry.type);
    }
  }

  void read_triple(IntTriple& triple) {
    const std::uint32_t count = in_.array_head();
    if (count != triple.size()) {
      in_.skip_bytes(std::uint64_t{count} * 4);
      return;
    }
    for (std::int64_t& v : triple) v = in_.i32();
  }

  NbtReader& in_;
  SchematicHead& head_;
};

std::optional<std::uint32_t> cell_varint(NbtArrayCursor& in) {
  std::uint32_t number = 0;
  for (int shift = 0; shift < 35 && in.has_more(); shift += 7) {
    const std::uint8_t byte = in.u8();
    number |= static_cast<std::uint32_t>(byte & 0x7fu) << shift;
    if (byte < 0x80) return number;
  }
  return std::nullopt;
}

Unexpected<Error> cells_end_early(const NbtArrayCursor& in) {
  if (!in.reader().ok()) return failure(in.reader().error());
  return fail(ErrorCode::truncated, "schematic: there are fewer cells than the sides say",
              in.offset());
}

Result<void> read_sponge_cells(ByteView file, const SchematicHead& head, GridPieces& out) {
  NbtArrayCursor in(file, head.cells);
  while (out.left() > 0) {
    if (!in.has_more()) return cells_end_early(in);
    const ByteView part = in.part();
    std::uint64_t count = 1;
    std::uint32_t number = part[0];
    if (number < 0x80) {
      const std::size_t end =
          static_cast<std::size_t>(std::min<std::uint64_t>(part.size(), out.left()));
      while (count < end && part[count] == number) ++count;
      in.advance(count);
    } else {
      const auto long_number = cell_varint(in);
      if (!long_number && !in.has_more()) return cells_end_early(in);
      if (!long_number)
        return fail(ErrorCode::bad_value, "schematic: a cell has more than 5 bytes", in.offset());
      number = *long_number;
    }
    const auto material = head.palette.find(number);
    if (!material) {
      return fail(ErrorCode::bad_value, "schematic: the palette has no block for a cell's number",
                  in.offset());
    }
    if (const auto appended = out.append(count, *material); !appended) return appended;
  }
  if (in.has_more()) {
    return fail(ErrorCode::trailing_bytes, "schematic: there are more cells than the sides say",
                in.offset());
  }
  return {};
}

/// The materials of the numbers of MCEdit, which are made when they first occur.
class NumberedBlocks {
 public:
  explicit NumberedBlocks(SchematicHead& head) : head_(head), materials_(kStates, kUnseen) {}

  const std::vector<ForeignBlock>& blocks() const { return blocks_; }
  Result<Material> find(std::uint32_t id, std::uint32_t data) {
    std::int32_t& material = materials_[id << 4 | data];
    if (material == kUnseen) {
      ForeignBlock block =
          block_of(static_cast<std::uint16_t>(id), static_cast<std::uint8_t>(data));
      if (block.name == kUntouchedBlock) {
        material = kEmpty;
      } else {
        const std::size_t bytes = sizeof(block) + block.name.size() + block.states.size();
        if (bytes > head_.name_bytes_left || blocks_.size() == SchematicPalette::kBlocksMax) {
          return fail(ErrorCode::limit_exceeded,
                      "schematic: more than 65534 blocks, or names of more than 24 MiB");
        }
        head_.name_bytes_left -= bytes;
        blocks_.push_back(std::move(block));
        material = static_cast<std::int32_t>(blocks_.size());
      }
    }
    return static_cast<Material>(material);
  }

 private:
  static constexpr std::size_t kStates = std::size_t{1} << 16;
  static constexpr std::int32_t kUnseen = -1;

  ForeignBlock block_of(std::uint16_t id, std::uint8_t data) const {
    const auto named = head_.mapping.find(id);
    const bool is_of_mod = named != head_.mapping.end() && !named->second.starts_with("minecraft:");
    if (!is_of_mod) {
      if (auto known = minecraft_block_of(id, data)) return *std::move(known);
    }
    const std::string states = data == 0 ? "" : "data=" + std::to_string(data);
    if (named != head_.mapping.end()) return {named->second, states};
    return {"numeric:" + std::to_string(id), states};
  }

  SchematicHead& head_;
  std::vector<std::int32_t> materials_;  // by id and data
  std::vector<ForeignBlock> blocks_;
};

Result<void> read_mcedit_cells(ByteView file, const SchematicHead& head, NumberedBlocks& blocks,
                               GridPieces& out) {
  NbtArrayCursor ids(file, head.blocks), data(file, head.data), add(file, head.add);
  // Schematica has the upper half of a byte first, WorldEdit the lower one.
  const unsigned first_shift = head.has_mapping ? 4 : 0;
  bool is_second = false;
  std::uint8_t halves = 0;
  while (out.left() > 0) {
    if (!ids.has_more()) return cells_end_early(ids);
    if (!data.has_more()) return cells_end_early(data);
    const ByteView id_part = ids.part(), data_part = data.part();
    std::uint32_t id = id_part[0];
    const std::uint8_t value = data_part[0];
    std::size_t count = 1;
    if (head.add.bytes > 0) {
      if (!is_second && !add.has_more()) return cells_end_early(add);
      if (!is_second) halves = add.u8();
      id |=
          (static_cast<std::uint32_t>(halves) >> (is_second ? 4 - first_shift : first_shift) & 15u)
          << 8;
      is_second = !is_second;
    } else {
      const std::size_t end = std::min(id_part.size(), data_part.size());
      while (count < end && id_part[count] == id_part[0] && data_part[count] == value) ++count;
    }
    ids.advance(count);
    data.advance(count);
    const auto material = blocks.find(id, value & 15u);
    if (!material) return failure(material.error());
    if (const auto appended = out.append(count, *material); !appended) return appended;
  }
  return {};
}

Result<VoxelBox> box_of_head(const SchematicHead& head) {
  std::uint64_t volume = 1;
  for (const std::int64_t side : head.sides) {
    if (side < 1 || side > kSchematicSideMax) {
      return fail(ErrorCode::bad_value,
                  "schematic: Width, Height or Length is missing or not 1 .. 65535");
    }
    volume *= static_cast<std::uint64_t>(side);
  }
  if (volume > kGridVolumeMax)
    return fail(ErrorCode::limit_exceeded, "schematic: more than 2147483647 cells");
  const auto side = [&](std::size_t axis) { return static_cast<std::int32_t>(head.sides[axis]); };
  return VoxelBox{{0, 0, 0}, {side(0), side(1), side(2)}};
}

/// Returns where the schematic was copied, or (0, 0, 0) if that is outside the world.
VoxelPos origin_of_head(const SchematicHead& head) {
  IntTriple low = head.origin;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] += head.offset[axis];
    if (low[axis] < -kWorldLimit || low[axis] + head.sides[axis] > kWorldLimit) return {};
  }
  return {static_cast<std::int32_t>(low[0]), static_cast<std::int32_t>(low[1]),
          static_cast<std::int32_t>(low[2])};
}

Result<void> check_head(const SchematicHead& head) {
  if (head.version && (*head.version < 1 || *head.version > kSpongeVersionMax))
    return fail(ErrorCode::bad_version, "schematic: Version is not 1 .. 3");
  const auto volume = static_cast<std::uint64_t>(head.sides[0] * head.sides[1] * head.sides[2]);
  if (head.has_palette) {
    if (head.cells.bytes == 0)
      return fail(ErrorCode::bad_value, "schematic: there is a palette, but no data of blocks");
    if (head.cells.bytes < volume) {
      return fail(ErrorCode::truncated, "schematic: there are fewer cells than the sides say",
                  head.cells.at + head.cells.bytes);
    }
    return {};
  }
  if (head.version || head.blocks.bytes == 0)
    return fail(ErrorCode::bad_value, "schematic: there are no blocks");
  if (!head.materials.empty() && head.materials != "Alpha")
    return fail(ErrorCode::unknown_kind, "schematic: Materials is not Alpha");
  if (head.blocks.bytes != volume || head.data.bytes != volume) {
    return fail(ErrorCode::bad_value,
                "schematic: Blocks or Data has another length than the sides say");
  }
  if (head.add.bytes > 0 && head.add.bytes != (volume + 1) / 2) {
    return fail(ErrorCode::bad_value, "schematic: AddBlocks has another length than the sides say");
  }
  return {};
}

}  // namespace

Result<ForeignInfo> read_schematic(ByteView file, const PieceSink& sink) {
  SchematicHead head;
  {
    NbtFileSource source(file);
    NbtReader in(source);
    SchematicHeadReader(in, head).read();
    if (!in.ok()) return failure(in.error());
  }
  const auto box = box_of_head(head);
  if (!box) return failure(box.error());
  if (const auto checked = check_head(head); !checked) return failure(checked.error());
  NumberedBlocks numbered(head);
  GridPieces rows(*box, AxisOrder::xzy,
                  head.has_palette ? head.palette.blocks() : numbered.blocks(), sink);
  const auto read = head.has_palette ? read_sponge_cells(file, head, rows)
                                     : read_mcedit_cells(file, head, numbered, rows);
  if (!read) return failure(read.error());
  ForeignInfo info;
  info.name = std::move(head.name);
  info.author = std::move(head.author);
  if (head.milliseconds > 0 && head.milliseconds <= kMillisecondsMax)
    info.created_us = head.milliseconds * 1000;
  info.origin = origin_of_head(head);
  return info;
}

}  // namespace runstone
