#include "bench/wire/palette_form.hpp"

#include <zlib.h>

#include "bench/wire/packed_longs.hpp"
#include "common/core/assert.hpp"

namespace runstone::bench {
namespace {

constexpr int kLevel = 6;
constexpr unsigned kDirectBits = 15;
constexpr std::size_t kSectionBytesMax = 8 * 1024 + 600;  // direct longs, and room for any head

struct Scratch {
  Bytes plain;
  std::vector<Material> palette;  // of the last encoded section
  std::vector<Material> names;    // of the last decoded section
  PackedLongs numbers;            // of the present section: palette indices, or ids
  Bytes received;
  // The place of each id in the palette; 0xffff: absent.
  std::vector<std::uint16_t> index_of = std::vector<std::uint16_t>(65536, 0xffff);
};

Scratch& scratch() {
  thread_local Scratch mine;
  return mine;
}

void put_long(Bytes& out, std::uint64_t v) {
  for (int shift = 56; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(v >> shift));
}

void put_longs(Bytes& out, const PackedLongs& numbers) {
  ByteWriter(out).varint(numbers.longs().size());
  for (const std::uint64_t word : numbers.longs()) put_long(out, word);
}

void put_section(const PaletteSection& section, Scratch& s) {
  for (const Material id : s.palette) s.index_of[id] = 0xffff;
  s.palette.clear();
  unsigned solid = 0;
  for (const Material id : section) {
    RUNSTONE_ASSERT(id < 1u << kDirectBits);
    solid += id != 0 ? 1 : 0;
    if (s.index_of[id] != 0xffff) continue;
    s.index_of[id] = static_cast<std::uint16_t>(s.palette.size());
    s.palette.push_back(id);
  }
  ByteWriter w(s.plain);
  w.u8(static_cast<std::uint8_t>(solid >> 8));
  w.u8(static_cast<std::uint8_t>(solid));
  if (s.palette.size() == 1) {
    w.u8(0);
    w.varint(s.palette[0]);
    w.varint(0);
    return;
  }
  const unsigned bits = palette_bits(s.palette.size());
  if (bits > kPaletteBitsMax) {
    w.u8(kDirectBits);
    s.numbers.reset(section.size(), kDirectBits);
    s.numbers.assign([&](std::size_t i) { return section[i]; });
    put_longs(s.plain, s.numbers);
    return;
  }
  w.u8(static_cast<std::uint8_t>(bits));
  w.varint(s.palette.size());
  for (const Material id : s.palette) w.varint(id);
  s.numbers.reset(section.size(), bits);
  s.numbers.assign([&](std::size_t i) { return s.index_of[section[i]]; });
  put_longs(s.plain, s.numbers);
}

Result<void> read_section(ByteReader& in, Scratch& s, PaletteSection& out) {
  in.bytes(2);
  const unsigned bits = in.u8();
  if (bits > kDirectBits) in.reject(ErrorCode::bad_value, "bits of a section");
  s.names.clear();
  if (bits == 0) {
    s.names.push_back(static_cast<Material>(in.varint_max(0x7fff, "id of a section")));
  } else if (bits <= kPaletteBitsMax) {
    const std::uint64_t count = in.varint_max(256, "palette of a section");
    for (std::uint64_t i = 0; i < count; ++i) {
      s.names.push_back(static_cast<Material>(in.varint_max(0x7fff, "id of a section")));
    }
  }
  const auto longs = static_cast<std::size_t>(in.varint_max(1024, "longs of a section"));
  const ByteView words = in.bytes(8 * longs);
  if (!in.ok()) return failure(in.error());
  if (bits == 0) {
    out.fill(s.names[0]);
    return {};
  }
  s.numbers.reset(out.size(), bits);
  if (longs != s.numbers.longs().size()) return fail(ErrorCode::bad_value, "longs of a section");
  const std::uint8_t* from = words.data();
  for (std::uint64_t& word : s.numbers.longs()) {
    for (std::size_t b = 0; b < 8; ++b) word = word << 8 | *from++;
  }
  std::size_t i = 0;
  std::uint32_t highest = 0;
  s.numbers.for_each([&](std::uint32_t value) {
    highest = std::max(highest, value);
    out[i++] = static_cast<Material>(value);
  });
  if (bits > kPaletteBitsMax) return {};
  if (highest >= s.names.size())
    return fail(ErrorCode::bad_value, "index behind the palette of a section");
  for (Material& voxel : out) voxel = s.names[voxel];
  return {};
}

}  // namespace

void encode_palette_sections(std::span<const PaletteSection> sections, Bytes& out) {
  Scratch& s = scratch();
  s.plain.clear();
  for (const PaletteSection& section : sections) put_section(section, s);
  const std::size_t at = out.size();
  uLongf size = compressBound(static_cast<uLong>(s.plain.size()));
  out.resize(at + size);
  const int status =
      compress2(out.data() + at, &size, s.plain.data(), static_cast<uLong>(s.plain.size()), kLevel);
  RUNSTONE_ASSERT(status == Z_OK);
  out.resize(at + size);
}

Result<void> decode_palette_sections(ByteView stream, std::span<PaletteSection> out) {
  Scratch& s = scratch();
  s.received.resize(out.size() * kSectionBytesMax);
  auto size = static_cast<uLongf>(s.received.size());
  if (uncompress(s.received.data(), &size, stream.data(), static_cast<uLong>(stream.size())) !=
      Z_OK) {
    return fail(ErrorCode::bad_value, "not a zlib stream of so many sections");
  }
  ByteReader in(ByteView(s.received).first(size));
  for (PaletteSection& section : out) {
    if (const auto read = read_section(in, s, section); !read) return read;
  }
  return in.finish();
}

}  // namespace runstone::bench
