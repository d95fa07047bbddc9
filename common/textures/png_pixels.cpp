#include "common/textures/png_pixels.hpp"

#include <algorithm>
#include <climits>
#include <cstdlib>
#include <memory>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr std::uint32_t kPngPixelsMax = 1U << 24;

/// The largest block of memory that the decoder gets. It doubles the block of unpacked bytes until
/// they fit, so without a bound a small file could unpack to a thousand times its bytes.
constexpr std::size_t kBlockBytesMin = 256 * 1024;
thread_local std::size_t block_bytes_max = kBlockBytesMin;

void* bounded_malloc(std::size_t bytes) {
  return bytes <= block_bytes_max ? std::malloc(bytes) : nullptr;
}
void* bounded_realloc(void* block, std::size_t bytes) {
  return bytes <= block_bytes_max ? std::realloc(block, bytes) : nullptr;
}

}  // namespace
}  // namespace runstone

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_ONLY_PNG
#define STBI_MALLOC(bytes) runstone::bounded_malloc(bytes)
#define STBI_REALLOC(block, bytes) runstone::bounded_realloc(block, bytes)
#define STBI_FREE(block) std::free(block)
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace runstone {

Result<PngPixels> read_png(ByteView png, std::uint32_t pixels_max) {
  RUNSTONE_ASSERT(pixels_max <= kPngPixelsMax);
  const auto sides = png_sides(png);
  if (!sides || png.size() > INT_MAX) return fail(ErrorCode::bad_value, "the picture is no PNG");
  if (std::uint64_t{sides->width} * sides->height > pixels_max)
    return fail(ErrorCode::limit_exceeded, "the picture has too many pixels");
  block_bytes_max = std::max(kBlockBytesMin, std::size_t{16} * pixels_max);
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(png.data(), static_cast<int>(png.size()), &width, &height, &channels,
                            4),
      &stbi_image_free);
  // A second head could change the sides.
  if (!pixels || static_cast<std::uint32_t>(width) != sides->width ||
      static_cast<std::uint32_t>(height) != sides->height)
    return fail(ErrorCode::bad_value, "the picture is damaged");
  const std::size_t bytes = std::size_t{4} * sides->width * sides->height;
  return PngPixels{*sides, {pixels.get(), pixels.get() + bytes}};
}

}  // namespace runstone
