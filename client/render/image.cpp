#include "client/render/image.hpp"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace runstone {

Image halved(const Image& image) {
  Image out{image.width / 2, image.height / 2, {}};
  out.rgb.reserve(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) * 3);
  const auto at = [&image](int x, int y, int c) -> unsigned {
    return image.rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(x)) *
                         3 +
                     static_cast<std::size_t>(c)];
  };
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const unsigned sum = at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) +
                             at(2 * x, 2 * y + 1, c) + at(2 * x + 1, 2 * y + 1, c);
        out.rgb.push_back(static_cast<std::uint8_t>((sum + 2) / 4));
      }
    }
  }
  return out;
}

Bytes encode_png(const Image& image) {
  // The pixels of flat faces repeat. Without a PNG filter the file is smaller and takes half the
  // time.
  stbi_write_force_png_filter = 0;
  Bytes out;
  const auto append = [](void* to, void* data, int size) {
    const auto* const bytes = static_cast<const std::uint8_t*>(data);
    auto& all = *static_cast<Bytes*>(to);
    all.insert(all.end(), bytes, bytes + size);
  };
  stbi_write_png_to_func(append, &out, image.width, image.height, 3, image.rgb.data(),
                         image.width * 3);
  return out;
}

}  // namespace runstone
