#include "common/textures/texture_picture.hpp"

#include <cstdlib>
#include <memory>

#include "common/core/texture.hpp"

namespace runstone {
namespace {

/// The largest block of memory that the decoder gets. The rows of the largest picture take 17 KiB,
/// and the decoder doubles the block of unpacked bytes until they fit. So a small file cannot unpack to
/// many bytes.
constexpr std::size_t kBlockBytesMax = 256 * 1024;

void* bounded_malloc(std::size_t bytes) {
  return bytes <= kBlockBytesMax ? std::malloc(bytes) : nullptr;
}
void* bounded_realloc(void* block, std::size_t bytes) {
  return bytes <= kBlockBytesMax ? std::realloc(block, bytes) : nullptr;
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
#define STBI_MAX_DIMENSIONS 64
#define STBI_MALLOC(bytes) runstone::bounded_malloc(bytes)
#define STBI_REALLOC(block, bytes) runstone::bounded_realloc(block, bytes)
#define STBI_FREE(block) std::free(block)
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace runstone {

static_assert(kTextureEdgeMax == STBI_MAX_DIMENSIONS);

Result<TexturePicture> read_texture(ByteView png) {
  const auto edge = texture_edge(png);
  if (!edge) return failure(edge.error());
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(png.data(), static_cast<int>(png.size()), &width, &height, &channels, 4),
      &stbi_image_free);
  // A second head could change the size.
  if (!pixels || width != *edge || height != *edge)
    return fail(ErrorCode::bad_value, "the picture is damaged");
  const std::size_t bytes = std::size_t{4} * *edge * *edge;
  return TexturePicture{*edge, {pixels.get(), pixels.get() + bytes}};
}

}  // namespace runstone
