// The bytes of a given texture: every limit, every truncation, and what is refused.
#include "common/edits/descriptor/given_texture.hpp"

#include <catch2/catch.hpp>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_memory.hpp"
#include "tests/support/textures/test_png.hpp"

namespace runstone::test {

TEST_CASE("the largest record of a texture fits its bound", "[edits][textures]") {
  GivenTexture largest{plain_png(16, 16, {}), {}};
  largest.png.resize(kTextureBytesMax);
  for (std::size_t i = 0; i < kTextureUsesMax; ++i)
    largest.uses.push_back({static_cast<Material>(60 * (i + 1)), 1});
  const EditDescriptor edit = texture_edit(largest);
  REQUIRE(validate(edit).has_value());
  const Bytes bytes = encode(edit);
  CHECK(bytes.size() <= descriptor_bytes_max(EditKind::texture));
  CHECK(memory_bytes(edit) >= kTextureBytesMax);
  const auto decoded = decode_descriptor(bytes);
  REQUIRE(decoded.has_value());
  CHECK(*decoded == edit);
  largest.png.push_back(0);
  CHECK_FALSE(validate(largest).has_value());
}

TEST_CASE("bytes of a given texture that are cut or changed are refused or valid",
          "[edits][textures]") {
  const Bytes good = encode(texture_edit({plain_png(16, 16, {9, 9, 9, 255}), {{3, 1}, {300, 62}}}));
  for (std::size_t size = 0; size < good.size(); ++size)
    CHECK_FALSE(decode_descriptor(ByteView(good).first(size)).has_value());
  Bytes longer = good;
  longer.push_back(0);
  CHECK_FALSE(decode_descriptor(longer).has_value());
  for (std::size_t at = 0; at < good.size(); ++at) {
    Bytes flipped = good;
    flipped[at] ^= 0x81;
    const auto decoded = decode_descriptor(flipped);
    if (decoded) CHECK(encode(*decoded) == flipped);
  }
}

TEST_CASE("an edit of a texture has no voxels and is none of players", "[edits][textures]") {
  const EditDescriptor edit = texture_edit({plain_png(16, 16, {}), {{35, 63}}});
  CHECK(kind_of(edit) == EditKind::texture);
  CHECK_FALSE(has_voxels(edit));
  CHECK_FALSE(changes_materials(edit));
  CHECK(given_texture_of(edit)->uses[0].material == 35);
  CHECK(bounding_box(edit).empty());
  CHECK_FALSE(decode_voxel_edit(encode(edit)).has_value());
  CHECK_FALSE(validate(EditDescriptor{TextureEdit{}, {}, kEmpty}).has_value());
  CHECK_FALSE(validate(texture_edit({{1, 2, 3}, {{35, 63}}})).has_value());
  CHECK_FALSE(validate(texture_edit({plain_png(16, 16, {}), {}})).has_value());
}

}  // namespace runstone::test
