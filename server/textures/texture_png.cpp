#include "server/textures/texture_png.hpp"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "common/core/texture.hpp"
#include "common/textures/png_pixels.hpp"
#include "common/textures/texture_picture.hpp"
#include "server/map/map_png.hpp"

namespace runstone {
namespace {

constexpr std::uint32_t kScaledSideMax = 1024;

std::string sides_text(const PngSides& sides) {
  return std::to_string(sides.width) + " x " + std::to_string(sides.height);
}

/// Returns a picture with an edge of 16, 32 or 64. Requires a power of two.
TexturePicture scaled(std::uint32_t edge, const std::vector<std::uint8_t>& rgba) {
  const std::uint32_t to = std::clamp<std::uint32_t>(edge, kTextureEdgeMin, kTextureEdgeMax);
  TexturePicture out{static_cast<std::uint16_t>(to),
                     std::vector<std::uint8_t>(std::size_t{4} * to * to)};
  const std::uint32_t block = std::max(1U, edge / to), times = std::max(1U, to / edge);
  for (std::uint32_t y = 0; y < to; ++y) {
    for (std::uint32_t x = 0; x < to; ++x) {
      // Colours are weighted by their alpha.
      std::uint64_t sum[4] = {};
      for (std::uint32_t j = 0; j < block; ++j) {
        for (std::uint32_t i = 0; i < block; ++i) {
          const std::size_t from =
              std::size_t{4} * ((y / times * block + j) * edge + x / times * block + i);
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += std::uint64_t{rgba[from + c]} * rgba[from + 3];
          sum[3] += rgba[from + 3];
        }
      }
      std::uint8_t* pixel = &out.rgba[std::size_t{4} * (y * to + x)];
      for (std::size_t c = 0; c < 3 && sum[3] > 0; ++c)
        pixel[c] = static_cast<std::uint8_t>((sum[c] + sum[3] / 2) / sum[3]);
      const std::uint64_t count = std::uint64_t{block} * block;
      pixel[3] = static_cast<std::uint8_t>((sum[3] + count / 2) / count);
    }
  }
  return out;
}

/// Returns the first square of a file.
Result<TexturePicture, std::string> square_of(ByteView file) {
  const auto sides = png_sides(file);
  if (!sides) return failure(std::string("is no PNG"));
  const auto [width, height] = *sides;
  if (height % width != 0 || !std::has_single_bit(width) || width > kScaledSideMax ||
      std::uint64_t{width} * height > kPicturePixelsMax)
    return failure(
        "has " + sides_text(*sides) +
        " pixels: a width of 1, 2, 4 .. 1024 and a height that is a multiple of it are read, "
        "4,194,304 pixels at most");
  const auto pixels = read_png(file, kPicturePixelsMax);
  if (!pixels) return failure(std::string(pixels.error().what));
  return scaled(width, pixels->rgba);
}

void lay_over(TexturePicture& lower, const TexturePicture& upper) {
  for (std::size_t i = 0; i < lower.rgba.size(); i += 4) {
    const unsigned alpha = upper.rgba[i + 3];
    const unsigned below = (255 - alpha) * lower.rgba[i + 3] / 255, whole = alpha + below;
    for (std::size_t c = 0; c < 3 && whole > 0; ++c) {
      lower.rgba[i + c] = static_cast<std::uint8_t>(
          (upper.rgba[i + c] * alpha + lower.rgba[i + c] * below + whole / 2) / whole);
    }
    lower.rgba[i + 3] = static_cast<std::uint8_t>(std::min(255U, whole));
  }
}

/// Gives the pixels that are not clear an average colour.
void colour(TexturePicture& picture, const std::array<std::uint8_t, 3>& tint) {
  std::array<std::uint64_t, 3> sum{};
  std::uint64_t weight = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c)
      sum[c] += std::uint64_t{picture.rgba[i + c]} * picture.rgba[i + 3];
    weight += picture.rgba[i + 3];
  }
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (sum[c] == 0) continue;
      const std::uint64_t value = picture.rgba[i + c] * weight * tint[c] / sum[c];
      picture.rgba[i + c] = static_cast<std::uint8_t>(std::min<std::uint64_t>(255, value));
    }
  }
}

Bytes encoded(const TexturePicture& picture) {
  std::vector<std::uint32_t> pixels;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    std::uint32_t pixel = 0;
    for (std::size_t c = 4; c > 0; --c) pixel = pixel << 8 | picture.rgba[i + c - 1];
    pixels.push_back(pixel);
  }
  const std::string png = png_of(pixels, picture.edge);
  return {png.begin(), png.end()};
}

}  // namespace

Result<Bytes, std::string> texture_png(std::span<const Bytes> layers,
                                       std::optional<std::array<std::uint8_t, 3>> tint) {
  if (layers.empty()) return failure(std::string("has no file"));
  if (layers.size() == 1 && !tint && read_texture(layers[0])) return layers[0];
  auto picture = square_of(layers[0]);
  if (!picture) return failure(picture.error());
  for (const Bytes& layer : layers.subspan(1)) {
    const auto upper = square_of(layer);
    if (upper && upper->edge == picture->edge) lay_over(*picture, *upper);
  }
  if (tint) colour(*picture, *tint);
  Bytes png = encoded(*picture);
  // The encoder compresses. Even an uncompressed picture of 64 x 64 pixels is smaller than this
  // limit.
  if (png.size() > kTextureBytesMax) return failure(std::string("takes more than 24,576 bytes"));
  return png;
}

}  // namespace runstone
