#include "common/formats/schematic_writer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/formats/grid_cells.hpp"
#include "common/formats/grid_pieces.hpp"
#include "common/formats/nbt_file.hpp"
#include "common/formats/schematic_names.hpp"
#include "common/formats/schematic_palette.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kSchemSideMax = 65'535;
constexpr std::int32_t kLitematicVersion = 6, kLitematicSubVersion = 1;
constexpr std::uint64_t kArrayCountMax = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kFillBytes = std::uint64_t{64} << 10;

/// The blocks of a file, and which of them each cell number of a build is.
struct FileBlocks {
  std::vector<ForeignBlock> blocks;
  std::vector<std::uint32_t> of_number;
  std::map<ForeignBlock, std::uint32_t> index;

  std::uint32_t add(ForeignBlock block) {
    const auto [at, is_new] =
        index.try_emplace(std::move(block), static_cast<std::uint32_t>(blocks.size()));
    if (is_new) blocks.push_back(at->first);
    return at->second;
  }
};

BuildMaterial named(const BuildMaterial& material, std::size_t entry) {
  BuildMaterial out = material;
  const bool is_empty = out.row.visibility == Visibility::empty;
  if (out.row.name.empty()) out.row.name = is_empty ? "air" : "material " + std::to_string(entry);
  return out;
}

/// `has_air_first`: entry 0 is air, as Litematica has it.
FileBlocks blocks_of(const FileBuild& file, bool has_air_first) {
  FileBlocks out;
  if (has_air_first) out.add({"minecraft:air", ""});
  out.of_number.push_back(0);
  for (std::size_t i = 0; i < file.materials.size(); ++i)
    out.of_number.push_back(out.add(schematic_block_of(named(file.materials[i], i))));
  if (file.build->touched() < file.build->volume())
    out.of_number[0] = out.add({std::string(kUntouchedBlock), ""});
  return out;
}

Result<void> check_size(const FileBuild& file, const FileBlocks& blocks) {
  RUNSTONE_ASSERT(file.materials.size() == file.build->palette().size());
  if (file.build->volume() > kGridVolumeMax) {
    return fail(ErrorCode::limit_exceeded,
                "the build has more than 2147483647 cells, and a schematic holds no more");
  }
  if (blocks.blocks.size() > SchematicPalette::kBlocksMax) {
    return fail(ErrorCode::limit_exceeded,
                "the build has more than 65534 blocks, and a schematic holds no more");
  }
  return {};
}

Unexpected<Error> cannot_write() {
  return fail(ErrorCode::io_failed, "the schematic cannot be written");
}

std::int64_t milliseconds_of(const BuildInfo& info) { return info.created_us / 1000; }

std::uint64_t varint_bytes_of(const FileBuild& file, const FileBlocks& blocks) {
  const std::vector<std::uint64_t> counts = count_cells(*file.build);
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < counts.size(); ++i)
    bytes += counts[i] * varint_size(blocks.of_number[i]);
  return bytes;
}

void write_schem_head(NbtWriter& out, const FileBuild& file, SchemVersion version) {
  const BuildInfo& info = file.info;
  const VoxelPos sides = file.build->sides();
  const auto side = [](std::int32_t v) {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(v));
  };
  out.i32("Version", static_cast<std::int32_t>(version));
  out.i32("DataVersion", kSchematicDataVersion);
  out.compound("Metadata");
  if (!info.name.empty()) out.string("Name", info.name);
  if (!info.author.empty()) out.string("Author", info.author);
  if (info.created_us > 0) out.i64("Date", milliseconds_of(info));
  const std::array origin{info.origin.x, info.origin.y, info.origin.z};
  // WorldEdit pastes at the place of the player plus this.
  constexpr std::array<std::int32_t, 3> kFromPlayer{};
  if (version == SchemVersion::three) {
    out.compound("WorldEdit");
    out.int_array("Origin", origin);
    out.end();
  } else {
    out.i32("WEOffsetX", kFromPlayer[0]);
    out.i32("WEOffsetY", kFromPlayer[1]);
    out.i32("WEOffsetZ", kFromPlayer[2]);
  }
  out.end();
  out.i16("Width", side(sides.x));
  out.i16("Height", side(sides.y));
  out.i16("Length", side(sides.z));
  // In version 2, WorldEdit has the place in the world here.
  out.int_array("Offset", version == SchemVersion::three ? kFromPlayer : origin);
}

/// Appends `count` cells, each as the same bytes. Returns false if the file cannot be written.
bool fill_cells(NbtFileWriter& out, std::uint64_t count, ByteView cell) {
  while (count > 0) {
    const std::uint64_t part = std::min(count, kFillBytes);
    if (cell.size() == 1) {
      out.plain().insert(out.plain().end(), static_cast<std::size_t>(part), cell[0]);
    } else {
      for (std::uint64_t i = 0; i < part; ++i)
        out.plain().insert(out.plain().end(), cell.begin(), cell.end());
    }
    if (!out.flush()) return false;
    count -= part;
  }
  return true;
}

void write_litematic_place(NbtWriter& out, std::string_view name, VoxelPos at) {
  out.compound(name);
  out.i32("x", at.x);
  out.i32("y", at.y);
  out.i32("z", at.z);
  out.end();
}

void write_litematic_head(NbtWriter& out, const FileBuild& file) {
  const BuildInfo& info = file.info;
  const auto clamped = [](std::uint64_t v) {
    return static_cast<std::int32_t>(std::min(v, kArrayCountMax));
  };
  out.i32("MinecraftDataVersion", kSchematicDataVersion);
  out.i32("Version", kLitematicVersion);
  out.i32("SubVersion", kLitematicSubVersion);
  out.compound("Metadata");
  out.i64("TimeCreated", milliseconds_of(info));
  out.i64("TimeModified", milliseconds_of(info));
  write_litematic_place(out, "EnclosingSize", file.build->sides());
  out.string("Description", "");
  out.i32("RegionCount", 1);
  out.i32("TotalBlocks", clamped(file.build->solid()));
  out.string("Author", info.author);
  out.i32("TotalVolume", clamped(file.build->volume()));
  out.string("Name", info.name);
  out.end();
}

void write_litematic_palette(NbtWriter& out, const FileBlocks& blocks) {
  out.list("BlockStatePalette", NbtType::compound, static_cast<std::int32_t>(blocks.blocks.size()));
  for (const ForeignBlock& block : blocks.blocks) {
    out.string("Name", block.name);
    if (!block.states.empty()) {
      out.compound("Properties");
      for (const auto& [key, value] : properties_of(block.states)) out.string(key, value);
      out.end();
    }
    out.end();
  }
}

/// Packs numbers into longs, the lowest bits first. A number may begin in one long and end in the next.
class NumberPacker {
 public:
  NumberPacker(NbtFileWriter& out, unsigned bits) : out_(out), bits_(bits) {}

  bool add(std::uint64_t count, std::uint32_t number) {
    for (; count > 0; --count) {
      long_ |= std::uint64_t{number} << filled_;
      filled_ += bits_;
      if (filled_ < 64) continue;
      put();
      if (!out_.flush()) return false;
      filled_ -= 64;
      // The bits of the number that the full long did not take.
      long_ = filled_ == 0 ? 0 : std::uint64_t{number} >> (bits_ - filled_);
    }
    return true;
  }
  void finish() {
    if (filled_ > 0) put();
  }

 private:
  void put() { out_.nbt().i64_value(static_cast<std::int64_t>(long_)); }
  NbtFileWriter& out_;
  unsigned bits_;
  std::uint64_t long_ = 0;
  unsigned filled_ = 0;
};

}  // namespace

Result<void> write_schem(const FileBuild& file, const FormatSink& sink) {
  return write_schem_with(file, {}, sink);
}

Result<void> write_schem_with(const FileBuild& file, const FileWriting& writing,
                              const FormatSink& sink) {
  const FileBlocks blocks = blocks_of(file, false);
  if (const auto checked = check_size(file, blocks); !checked) return checked;
  const VoxelPos sides = file.build->sides();
  if (std::max({sides.x, sides.y, sides.z}) > kSchemSideMax) {
    return fail(ErrorCode::limit_exceeded,
                "a side of the build is longer than 65535, which is the longest of a .schem");
  }
  const std::uint64_t data_bytes = varint_bytes_of(file, blocks);
  if (data_bytes > kArrayCountMax) {
    return fail(ErrorCode::limit_exceeded,
                "the cells take more than 2147483647 bytes, and a .schem holds no more");
  }
  NbtFileWriter out(sink);
  NbtWriter& nbt = out.nbt();
  const bool is_nested = writing.schem == SchemVersion::three;
  if (is_nested) nbt.compound("");
  nbt.compound("Schematic");
  write_schem_head(nbt, file, writing.schem);
  if (is_nested)
    nbt.compound("Blocks");
  else
    nbt.i32("PaletteMax", static_cast<std::int32_t>(blocks.blocks.size()));
  nbt.compound("Palette");
  for (std::size_t i = 0; i < blocks.blocks.size(); ++i)
    nbt.i32(schematic_text_of(blocks.blocks[i]), static_cast<std::int32_t>(i));
  nbt.end();
  nbt.array(is_nested ? "Data" : "BlockData", NbtType::byte_array,
            static_cast<std::int32_t>(data_bytes));
  Bytes cell;
  const auto walked = walk_cells(*file.build, AxisOrder::xzy,
                                 [&](std::uint32_t count, std::uint16_t number) -> Result<void> {
                                   cell.clear();
                                   ByteWriter(cell).varint(blocks.of_number[number]);
                                   if (!fill_cells(out, count, cell)) return cannot_write();
                                   return {};
                                 });
  if (!walked) return walked;
  nbt.list("BlockEntities", NbtType::compound, 0);
  for (int open = 0; open < (is_nested ? 3 : 1); ++open) nbt.end();
  if (!out.finish()) return cannot_write();
  return {};
}

Result<void> write_litematic(const FileBuild& file, const FormatSink& sink) {
  const FileBlocks blocks = blocks_of(file, true);
  if (const auto checked = check_size(file, blocks); !checked) return checked;
  const unsigned bits =
      std::max(2u, static_cast<unsigned>(std::bit_width(blocks.blocks.size() - 1)));
  const std::uint64_t longs = (file.build->volume() * bits + 63) / 64;
  NbtFileWriter out(sink);
  NbtWriter& nbt = out.nbt();
  nbt.compound("");
  write_litematic_head(nbt, file);
  nbt.compound("Regions");
  nbt.compound(file.info.name.empty() ? std::string_view("build") : file.info.name);
  write_litematic_place(nbt, "Position", {0, 0, 0});
  write_litematic_place(nbt, "Size", file.build->sides());
  write_litematic_palette(nbt, blocks);
  nbt.array("BlockStates", NbtType::long_array, static_cast<std::int32_t>(longs));
  NumberPacker packer(out, bits);
  const auto walked = walk_cells(*file.build, AxisOrder::xzy,
                                 [&](std::uint32_t count, std::uint16_t number) -> Result<void> {
                                   if (!packer.add(count, blocks.of_number[number]))
                                     return cannot_write();
                                   return {};
                                 });
  if (!walked) return walked;
  packer.finish();
  for (const std::string_view list :
       {"TileEntities", "Entities", "PendingBlockTicks", "PendingFluidTicks"})
    nbt.list(list, NbtType::compound, 0);
  for (int open = 0; open < 3; ++open) nbt.end();
  if (!out.finish()) return cannot_write();
  return {};
}

}  // namespace runstone
