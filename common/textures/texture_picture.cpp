#include "common/textures/texture_picture.hpp"

#include <utility>

#include "common/core/texture.hpp"
#include "common/textures/png_pixels.hpp"

namespace runstone {

Result<TexturePicture> read_texture(ByteView png) {
  const auto edge = texture_edge(png);
  if (!edge) return failure(edge.error());
  auto pixels = read_png(png, kTextureEdgeMax * kTextureEdgeMax);
  if (!pixels) return failure(pixels.error());
  return TexturePicture{*edge, std::move(pixels->rgba)};
}

}  // namespace runstone
