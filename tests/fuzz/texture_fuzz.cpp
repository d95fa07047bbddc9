// The target decodes any bytes as a texture, and with a sound head, which random bytes would hardly
// ever have. Whatever is decoded has the pixels that its edge says.
#include <algorithm>
#include <array>
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/core/texture.hpp"
#include "common/textures/texture_picture.hpp"

using namespace runstone;

namespace {

void decode(ByteView file) {
  const auto edge = texture_edge(file);
  const auto picture = read_texture(file);
  RUNSTONE_ASSERT(edge.has_value() || !picture.has_value());
  if (!picture) return;
  RUNSTONE_ASSERT(picture->edge == *edge);
  RUNSTONE_ASSERT(picture->rgba.size() == std::size_t{4} * *edge * *edge);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  decode({data, size});
  constexpr std::array<std::uint8_t, 24> kHead = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n',
                                                  0,    0,   0,   13,  'I',  'H',  'D',  'R',
                                                  0,    0,   0,   16,  0,    0,    0,    16};
  Bytes mended(data, data + size);
  if (mended.size() < kHead.size()) return 0;
  std::copy(kHead.begin(), kHead.end(), mended.begin());
  decode(mended);
  return 0;
}
