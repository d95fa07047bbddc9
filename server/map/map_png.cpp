#include "server/map/map_png.hpp"

#include <libdeflate.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

// The file has the bytes of a pixel in the order red, green, blue, alpha.
static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kColoursMax = 256;

/// The bytes of a picture before they are compressed. Each row begins with a 0: no filter. Filters find
/// nothing in indices, and slopes change from pixel to pixel.
struct Rows {
  std::vector<std::uint32_t> colours;  // empty: the bytes are pixels, not indices of colours
  std::vector<std::uint8_t> bytes;
};

/// Returns nullopt if there are more than kColoursMax colours.
std::optional<Rows> indexed_rows(std::span<const std::uint32_t> pixels, std::size_t side) {
  // There are four times as many slots as colours, so few colours collide.
  constexpr std::size_t kSlots = 1024;
  struct Slot {
    std::uint32_t colour = 0;
    std::int32_t index = -1;  // in the colours; negative: the slot is free
  };
  std::array<Slot, kSlots> slots{};
  Rows out{{}, std::vector<std::uint8_t>(side * (side + 1))};
  std::uint8_t* at = out.bytes.data();
  for (std::size_t row = 0; row < side; ++row) {
    *at++ = 0;
    for (const std::uint32_t pixel : pixels.subspan(row * side, side)) {
      std::size_t slot = pixel * 0x9e3779b1U >> 22;  // multiplicative hashing
      while (slots[slot].index >= 0 && slots[slot].colour != pixel) slot = (slot + 1) % kSlots;
      if (slots[slot].index < 0) {
        if (out.colours.size() == kColoursMax) return std::nullopt;
        slots[slot] = {pixel, static_cast<std::int32_t>(out.colours.size())};
        out.colours.push_back(pixel);
      }
      *at++ = static_cast<std::uint8_t>(slots[slot].index);
    }
  }
  return out;
}

Rows pixel_rows(std::span<const std::uint32_t> pixels, std::size_t side) {
  const std::size_t row_bytes = side * sizeof(std::uint32_t);
  Rows out{{}, std::vector<std::uint8_t>(side * (row_bytes + 1))};
  for (std::size_t row = 0; row < side; ++row)
    std::memcpy(&out.bytes[row * (row_bytes + 1) + 1], &pixels[row * side], row_bytes);
  return out;
}

std::string big_endian(std::uint32_t value) {
  std::string out;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) out += static_cast<char>(value >> shift & 255U);
  return out;
}

/// Appends a chunk of the file: its length, type, data and the CRC of type and data.
void append_chunk(std::string& out, std::string_view type, std::string_view data) {
  out += big_endian(static_cast<std::uint32_t>(data.size()));
  const std::size_t checked = out.size();
  out += type;
  out += data;
  out += big_endian(libdeflate_crc32(0, out.data() + checked, out.size() - checked));
}

std::string deflated(const std::vector<std::uint8_t>& bytes) {
  // Higher levels take two to five times as long and save an eighth of the bytes.
  constexpr int kLevel = 1;
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kLevel), &libdeflate_free_compressor);
  RUNSTONE_ASSERT(compressor != nullptr);
  std::string out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
  out.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(),
                                      out.size()));
  return out;
}

}  // namespace

std::string png_of(std::span<const std::uint32_t> pixels, std::int32_t side) {
  RUNSTONE_ASSERT(side > 0 &&
                  pixels.size() == static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  const auto width = static_cast<std::size_t>(side);
  std::optional<Rows> with_palette = indexed_rows(pixels, width);
  const bool has_palette = with_palette.has_value();
  const Rows rows = has_palette ? *std::move(with_palette) : pixel_rows(pixels, width);
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  // Bits of a sample, kind of pixels (indices of colours, or colours with alpha), compression,
  // filters, and no interlacing.
  constexpr std::string_view kIndices("\x08\x03\0\0\0", 5), kPixels("\x08\x06\0\0\0", 5);
  std::string out(kSignature);
  const std::string both_sides =
      big_endian(static_cast<std::uint32_t>(side)) + big_endian(static_cast<std::uint32_t>(side));
  append_chunk(out, "IHDR", both_sides + std::string(has_palette ? kIndices : kPixels));
  if (has_palette) {
    std::string colours, alphas;
    for (const std::uint32_t colour : rows.colours) {
      for (const unsigned shift : {0U, 8U, 16U})
        colours += static_cast<char>(colour >> shift & 255U);
      alphas += static_cast<char>(colour >> 24U);
    }
    append_chunk(out, "PLTE", colours);
    append_chunk(out, "tRNS", alphas);
  }
  append_chunk(out, "IDAT", deflated(rows.bytes));
  append_chunk(out, "IEND", {});
  return out;
}

}  // namespace runstone
