#include "server/map/map_png.hpp"

#include <png.h>

#include <array>
#include <bit>
#include <cstddef>
#include <optional>
#include <vector>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

// libpng reads the bytes of a pixel in the order red, green, blue, alpha.
static_assert(std::endian::native == std::endian::little);

/// A picture whose pixels are indices of colours.
struct Indexed {
  std::vector<std::uint32_t> colours;
  std::vector<std::uint8_t> pixels;
};

constexpr std::size_t kColoursMax = 256;

/// Returns nullopt if there are more than kColoursMax colours.
std::optional<Indexed> indexed(std::span<const std::uint32_t> pixels) {
  // There are four times as many slots as colours, so few colours collide.
  constexpr std::size_t kSlots = 1024;
  std::array<std::int16_t, kSlots> index_in{};
  index_in.fill(-1);
  Indexed out;
  out.pixels.reserve(pixels.size());
  std::uint32_t last = 0;
  std::uint8_t last_index = 0;
  bool has_last = false;
  for (const std::uint32_t pixel : pixels) {
    if (!has_last || pixel != last) {
      std::size_t slot = pixel * 0x9e3779b1U >> 22;  // multiplicative hashing
      while (index_in[slot] >= 0 && out.colours[static_cast<std::size_t>(index_in[slot])] != pixel)
        slot = (slot + 1) % kSlots;
      if (index_in[slot] < 0) {
        if (out.colours.size() == kColoursMax) return std::nullopt;
        index_in[slot] = static_cast<std::int16_t>(out.colours.size());
        out.colours.push_back(pixel);
      }
      last = pixel;
      last_index = static_cast<std::uint8_t>(index_in[slot]);
      has_last = true;
    }
    out.pixels.push_back(last_index);
  }
  return out;
}

}  // namespace

std::string png_of(std::span<const std::uint32_t> pixels, std::int32_t side) {
  RUNSTONE_ASSERT(side > 0 &&
                  pixels.size() == static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  const auto with_palette = indexed(pixels);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = static_cast<png_uint_32>(side);
  image.format = with_palette ? PNG_FORMAT_RGBA_COLORMAP : PNG_FORMAT_RGBA;
  image.flags = PNG_IMAGE_FLAG_FAST;
  const void* buffer = pixels.data();
  const void* palette = nullptr;
  if (with_palette) {
    image.colormap_entries = static_cast<png_uint_32>(with_palette->colours.size());
    buffer = with_palette->pixels.data();
    palette = with_palette->colours.data();
  }
  std::string out(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t bytes = out.size();
  const int is_written =
      png_image_write_to_memory(&image, out.data(), &bytes, 0, buffer, 0, palette);
  RUNSTONE_ASSERT(is_written != 0);
  out.resize(bytes);
  out.shrink_to_fit();
  return out;
}

}  // namespace runstone
