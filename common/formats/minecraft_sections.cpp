#include "common/formats/minecraft_sections.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>

#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_region.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kPieceSections = 4;  // a piece is up to 64 voxels high
constexpr std::size_t kPaletteMax = kSectionVoxels;
// Before 1.18 a chunk has 16 sections, of which those of air are missing.
constexpr std::int32_t kOldSections = 16;
constexpr std::size_t kNumbers = 4096;  // ids of a byte, with data

/// Returns the blocks of the numbers id * 16 + data. They are made once, at the first call.
const std::vector<ForeignBlock>& blocks_of_numbers() {
  static const std::vector<ForeignBlock> blocks = [] {
    std::vector<ForeignBlock> made;
    made.reserve(kNumbers);
    for (std::uint16_t number = 0; number < kNumbers; ++number) {
      const auto id = static_cast<std::uint16_t>(number >> 4);
      const auto data = static_cast<std::uint8_t>(number & 15);
      auto block = minecraft_block_of(id, data);
      made.push_back(
          block ? std::move(*block)
                : ForeignBlock{"numeric:" + std::to_string(id), "data=" + std::to_string(data)});
    }
    return made;
  }();
  return blocks;
}

unsigned nibble(ByteView nibbles, std::uint32_t i) {
  return nibbles.empty() ? 0U : nibbles[i / 2] >> (i % 2 * 4) & 15U;
}

std::string_view text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

void MinecraftPieces::clear() {
  blocks_.clear();
  name_bytes_ = 0;
  of_entry_.clear();
  for (const std::uint16_t number : numbers_) of_number_[number] = kEmpty;
  numbers_.clear();
  air_ = kEmpty;
}

Result<Material> MinecraftPieces::add(ForeignBlock block) {
  name_bytes_ += block.name.size() + block.states.size();
  if (name_bytes_ > kMinecraftNameBytesMax) {
    return fail(ErrorCode::limit_exceeded,
                "minecraft chunk: names and states of four sections take more than 1 MiB");
  }
  blocks_.push_back(std::move(block));
  // At most 4 * 4096 blocks and air.
  return static_cast<Material>(blocks_.size());
}

Result<Material> MinecraftPieces::air() {
  if (air_ == kEmpty) {
    const auto added = add({"minecraft:air", ""});
    if (!added) return added;
    air_ = *added;
  }
  return air_;
}

Result<Material> MinecraftPieces::material_of_entry(ByteView entry) {
  const auto [known, is_new] = of_entry_.try_emplace(text_of(entry), kEmpty);
  if (!is_new) return known->second;
  NbtReader in(entry);
  ForeignBlock block = read_palette_block(in);
  if (in.ok() && block.name.empty())
    in.reject(ErrorCode::bad_value, "minecraft chunk: an entry of a palette has no Name");
  if (!in.ok()) return failure(in.error());
  const auto added =
      block.name == "minecraft:air" && block.states.empty() ? air() : add(std::move(block));
  if (added) known->second = *added;
  return added;
}

Result<Material> MinecraftPieces::material_of_number(std::uint16_t number) {
  Material& known = of_number_[number];
  if (known != kEmpty) return known;
  Result<Material> added =
      number < 16 ? air()
      : number < kNumbers
          ? add(blocks_of_numbers()[number])
          : add({"numeric:" + std::to_string(number >> 4), "data=" + std::to_string(number & 15)});
  if (added) {
    known = *added;
    numbers_.push_back(number);
  }
  return added;
}

Result<void> MinecraftPieces::read_palette(ByteView plain, const MinecraftSection& section) {
  NbtReader in(plain.subspan(section.palette_at));
  const NbtList list = in.list();
  if (list.count == 0 || list.type != NbtType::compound)
    in.reject(ErrorCode::bad_value, "minecraft chunk: a palette is no list of blocks");
  if (list.count > kPaletteMax)
    in.reject(ErrorCode::limit_exceeded, "minecraft chunk: a palette has more than 4096 blocks");
  palette_.clear();
  for (std::uint32_t i = 0; i < list.count && in.ok(); ++i) {
    const std::size_t begin = section.palette_at + in.offset();
    in.skip(NbtType::compound);
    if (!in.ok()) break;
    const auto material =
        material_of_entry(plain.subspan(begin, section.palette_at + in.offset() - begin));
    if (!material) {
      Error error = material.error();
      error.offset += begin;
      return failure(error);
    }
    palette_.push_back(*material);
  }
  if (in.ok()) return {};
  Error error = in.error();
  error.offset += section.palette_at;
  return failure(error);
}

Result<void> MinecraftPieces::append_states(NbtLongs longs, unsigned bits, bool crossing,
                                            RunBuilder& out) {
  const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  std::uint64_t last = longs[0] & mask;
  std::uint32_t count = 0;  // values equal to `last` that are not yet appended
  const auto flush = [&] {
    if (last >= palette_.size()) return false;
    out.append(count, palette_[last]);
    return true;
  };
  constexpr auto kBadIndex = "minecraft chunk: a block lies outside its palette";
  if (crossing && 64 % bits != 0) {
    for (std::uint32_t i = 0; i < kSectionVoxels; ++i) {
      const std::uint32_t at = i * bits, shift = at % 64;
      std::uint64_t value = longs[at / 64] >> shift;
      if (shift + bits > 64) value |= longs[at / 64 + 1] << (64 - shift);
      value &= mask;
      if (value != last) {
        if (!flush()) return fail(ErrorCode::bad_value, kBadIndex, i);
        last = value;
        count = 0;
      }
      ++count;
    }
  } else {
    const std::uint32_t per_long = 64 / bits;
    std::uint64_t ones = 0;  // 1 in each value of a long
    for (std::uint32_t i = 0; i < per_long; ++i) ones |= std::uint64_t{1} << (i * bits);
    std::uint64_t same = ones * last;
    for (std::uint32_t i = 0, done = 0; done < kSectionVoxels; ++i) {
      const std::uint32_t here = std::min(per_long, kSectionVoxels - done);
      std::uint64_t word = longs[i];
      done += here;
      if (word == same && here == per_long) {
        count += here;
        continue;
      }
      for (std::uint32_t k = 0; k < here; ++k, word >>= bits) {
        if ((word & mask) != last) {
          if (!flush()) return fail(ErrorCode::bad_value, kBadIndex, done - here + k);
          last = word & mask;
          count = 0;
        }
        ++count;
      }
      same = ones * last;
    }
  }
  if (!flush()) return fail(ErrorCode::bad_value, kBadIndex, kSectionVoxels);
  return {};
}

Result<void> MinecraftPieces::append_numbers(const MinecraftSection& section, RunBuilder& out) {
  const auto number_at = [&](std::uint32_t i) {
    return static_cast<std::uint16_t>(nibble(section.add, i) << 12 |
                                      unsigned{section.blocks[i]} << 4 | nibble(section.data, i));
  };
  std::uint16_t last = number_at(0);
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i <= kSectionVoxels; ++i) {
    if (i < kSectionVoxels && number_at(i) == last) {
      ++count;
      continue;
    }
    const auto material = material_of_number(last);
    if (!material) return failure(material.error());
    out.append(count, *material);
    if (i == kSectionVoxels) break;
    last = number_at(i);
    count = 1;
  }
  return {};
}

Result<void> MinecraftPieces::append_section(ByteView plain, const MinecraftSection& section,
                                             std::int64_t version, RunBuilder& out) {
  if (section.palette_at == 0) return append_numbers(section, out);
  if (auto read = read_palette(plain, section); !read) return read;
  if (!section.states || section.states->empty()) {
    if (palette_.size() != 1) {
      return fail(ErrorCode::bad_value, "minecraft chunk: a section has a palette and no blocks",
                  section.palette_at);
    }
    out.append(kSectionVoxels, palette_.front());
    return {};
  }
  bool crossing = false;
  const unsigned bits = section_bits(palette_.size(), section.states->size(), version, crossing);
  if (bits == 0) {
    return fail(ErrorCode::bad_value,
                "minecraft chunk: number of longs does not fit the palette of a section",
                section.palette_at);
  }
  return append_states(*section.states, bits, crossing, out);
}

Result<void> MinecraftPieces::give(ByteView plain, const MinecraftChunk& chunk, VoxelPos origin,
                                   const PieceSink& sink) {
  std::int32_t low = chunk.sections.front().y, high = chunk.sections.back().y;
  if (chunk.has_level) {
    low = std::min(low, 0);
    high = std::max(high, kOldSections - 1);
  }
  auto next = chunk.sections.begin();
  for (std::int32_t y = low; y <= high;) {
    const std::int32_t end =
        std::min(high + 1, (floor_div(y, kPieceSections) + 1) * kPieceSections);
    clear();
    RunBuilder out({kMinecraftSection, static_cast<std::uint8_t>((end - y) * kMinecraftSection),
                    kMinecraftSection},
                   AxisOrder::xzy);
    const VoxelPos at{origin.x, y * kMinecraftSection, origin.z};
    for (; y < end; ++y) {
      if (next != chunk.sections.end() && next->y == y) {
        if (auto appended = append_section(plain, *next, chunk.version, out); !appended)
          return appended;
        ++next;
        continue;
      }
      const auto material = air();
      if (!material) return failure(material.error());
      out.append(kSectionVoxels, *material);
    }
    if (auto taken = sink({at, out.finish(), std::move(blocks_)}); !taken) return taken;
    blocks_ = {};
  }
  return {};
}

}  // namespace runstone
