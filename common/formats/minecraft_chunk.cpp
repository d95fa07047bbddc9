#include "common/formats/minecraft_chunk.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace runstone {
namespace {

constexpr std::size_t kSectionsMax = 256;
constexpr std::size_t kNibbleBytes = kSectionVoxels / 2;
constexpr std::size_t kBlockStatesMax = 64;  // keys of one block; the game has at most 7
// The first version (20w17a) in which values do not cross from long to long.
constexpr std::int64_t kUncrossedVersion = 2529;
constexpr unsigned kSectionBitsMin = 4, kSectionBitsMax = 16;

void read_array(NbtReader& in, std::size_t bytes, const char* what, ByteView& out) {
  out = in.byte_array();
  if (in.ok() && out.size() != bytes) in.reject(ErrorCode::bad_value, what);
}

void read_block_states(NbtReader& in, MinecraftSection& section) {
  NbtEntry entry;
  while (in.next(entry)) {
    if (entry.is("palette", NbtType::list)) {
      section.palette_at = in.offset();
      in.skip(NbtType::list);
    } else if (entry.is("data", NbtType::long_array)) {
      section.states = in.long_array();
    } else {
      in.skip(entry.type);
    }
  }
}

void read_section(NbtReader& in, MinecraftSection& section) {
  NbtEntry entry;
  while (in.next(entry)) {
    if (entry.name == "Y") {
      const std::int64_t y = in.integer(entry.type, "minecraft chunk: Y is no integer");
      if (y < -128 || y > 127)
        in.reject(ErrorCode::bad_value, "minecraft chunk: Y lies outside -128 .. 127");
      section.y = static_cast<std::int32_t>(y);
      section.has_y = true;
    } else if (entry.is("block_states", NbtType::compound)) {
      read_block_states(in, section);
    } else if (entry.is("Palette", NbtType::list)) {
      section.palette_at = in.offset();
      in.skip(NbtType::list);
    } else if (entry.is("BlockStates", NbtType::long_array)) {
      section.states = in.long_array();
    } else if (entry.is("Blocks", NbtType::byte_array)) {
      read_array(in, kSectionVoxels, "minecraft chunk: Blocks is not of 4096 bytes",
                 section.blocks);
    } else if (entry.is("Data", NbtType::byte_array)) {
      read_array(in, kNibbleBytes, "minecraft chunk: Data is not of 2048 bytes", section.data);
    } else if (entry.is("Add", NbtType::byte_array)) {
      read_array(in, kNibbleBytes, "minecraft chunk: Add is not of 2048 bytes", section.add);
    } else {
      in.skip(entry.type);
    }
  }
}

void read_sections(NbtReader& in, MinecraftChunk& chunk) {
  const NbtList list = in.list();
  if (list.count == 0) return;
  if (list.type != NbtType::compound)
    in.reject(ErrorCode::bad_value, "minecraft chunk: sections are no compounds");
  if (list.count > kSectionsMax)
    in.reject(ErrorCode::limit_exceeded, "minecraft chunk: more than 256 sections");
  for (std::uint32_t i = 0; i < list.count && in.ok(); ++i) {
    MinecraftSection section;
    read_section(in, section);
    if (!section.has_blocks()) continue;  // light only
    if (!section.has_y) in.reject(ErrorCode::bad_value, "minecraft chunk: a section has no Y");
    if (chunk.sections.size() == kSectionsMax)
      in.reject(ErrorCode::limit_exceeded, "minecraft chunk: more than 256 sections");
    if (in.ok()) chunk.sections.push_back(section);
  }
}

/// Reads what stands in the root since 1.18, and in "Level" before.
void read_chunk_part(NbtReader& in, const NbtEntry& entry, MinecraftChunk& chunk) {
  if (entry.is("xPos", NbtType::i32)) {
    chunk.x = in.i32();
  } else if (entry.is("zPos", NbtType::i32)) {
    chunk.z = in.i32();
  } else if (entry.is("sections", NbtType::list) || entry.is("Sections", NbtType::list)) {
    read_sections(in, chunk);
  } else {
    in.skip(entry.type);
  }
}

std::size_t uncrossed_longs(unsigned bits) {
  const unsigned per_long = 64 / bits;
  return (kSectionVoxels + per_long - 1) / per_long;
}

}  // namespace

Result<void> scan_minecraft_chunk(ByteView plain, MinecraftChunk& out) {
  out.x = out.z = std::nullopt;
  out.version = 0;
  out.has_level = false;
  out.sections.clear();
  NbtReader in(plain);
  in.root();
  NbtEntry entry, part;
  while (in.next(entry)) {
    if (entry.name == "DataVersion") {
      out.version = in.integer(entry.type, "minecraft chunk: DataVersion is no integer");
    } else if (entry.is("Level", NbtType::compound)) {
      out.has_level = true;
      while (in.next(part)) read_chunk_part(in, part, out);
    } else {
      read_chunk_part(in, entry, out);
    }
  }
  if (!in.ok()) return failure(in.error());
  std::sort(out.sections.begin(), out.sections.end(),
            [](const auto& a, const auto& b) { return a.y < b.y; });
  const auto twice = std::adjacent_find(out.sections.begin(), out.sections.end(),
                                        [](const auto& a, const auto& b) { return a.y == b.y; });
  if (twice != out.sections.end())
    return fail(ErrorCode::bad_value, "minecraft chunk: two sections have one Y", in.offset());
  return {};
}

ForeignBlock read_palette_block(NbtReader& in) {
  ForeignBlock block;
  std::vector<std::pair<std::string_view, std::string_view>> states;
  NbtEntry entry;
  while (in.next(entry)) {
    if (entry.is("Name", NbtType::string)) {
      block.name = in.string();
    } else if (entry.is("Properties", NbtType::compound)) {
      NbtEntry state;
      while (in.next(state)) {
        if (state.type != NbtType::string) {
          in.reject(ErrorCode::bad_value, "minecraft chunk: a property is no string");
        } else if (states.size() == kBlockStatesMax) {
          in.reject(ErrorCode::limit_exceeded, "minecraft chunk: more than 64 properties");
        } else {
          states.emplace_back(state.name, in.string());
        }
      }
    } else {
      in.skip(entry.type);
    }
  }
  std::sort(states.begin(), states.end());
  for (const auto& [key, value] : states) {
    if (!block.states.empty()) block.states += ',';
    block.states.append(key).append("=").append(value);
  }
  return block;
}

unsigned section_bits(std::size_t palette_size, std::size_t longs, std::int64_t version,
                      bool& crossing) {
  const auto needed =
      std::max(kSectionBitsMin, static_cast<unsigned>(std::bit_width(palette_size - 1)));
  const std::size_t crossed_longs = kSectionVoxels / 64 * needed;
  // Most sections have the width that their palette needs. If the number of longs fits both layouts,
  // these are equal.
  crossing = longs == crossed_longs;
  if (crossing || longs == uncrossed_longs(needed)) return needed;
  // Some programs write wider values.
  for (unsigned bits = needed + 1; bits <= kSectionBitsMax; ++bits) {
    crossing = version < kUncrossedVersion;
    if (longs == (crossing ? kSectionVoxels / 64 * bits : uncrossed_longs(bits))) return bits;
  }
  return 0;
}

}  // namespace runstone
