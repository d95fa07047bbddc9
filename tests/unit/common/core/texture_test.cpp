// The head of a texture, and the uses of one.
#include "common/core/texture.hpp"

#include <catch2/catch.hpp>

#include "tests/support/textures/test_png.hpp"

namespace runstone::test {
namespace {

ErrorCode fault_of_head(const Bytes& png) {
  const auto edge = texture_edge(png);
  REQUIRE_FALSE(edge.has_value());
  return edge.error().code;
}

}  // namespace

TEST_CASE("the head of a PNG says its edge, or why it is no texture", "[textures]") {
  for (const std::uint32_t edge : {16U, 32U, 64U})
    CHECK(*texture_edge(plain_png(edge, edge, {1, 2, 3, 255})) == edge);
  CHECK(fault_of_head({}) == ErrorCode::bad_value);
  CHECK(fault_of_head({'G', 'I', 'F'}) == ErrorCode::bad_value);
  CHECK(fault_of_head(plain_png(16, 32, {})) == ErrorCode::bad_value);
  CHECK(fault_of_head(plain_png(20, 20, {})) == ErrorCode::bad_value);
  CHECK(fault_of_head(plain_png(128, 128, {})) == ErrorCode::bad_value);
  CHECK(fault_of_head(bytes_of({16'384, 16'384, 8, 6, {0}})) == ErrorCode::bad_value);
  CHECK(fault_of_head(bytes_of({16, 16, 16, 6, {0}})) == ErrorCode::bad_value);
  CHECK(fault_of_head(bytes_of({16, 16, 8, 5, {0}})) == ErrorCode::bad_value);
  CHECK(texture_edge(bytes_of({16, 16, 4, 3, {0}})).has_value());
  Bytes longest = plain_png(16, 16, {});
  longest.resize(kTextureBytesMax);
  CHECK(texture_edge(longest).has_value());
  longest.push_back(0);
  CHECK(fault_of_head(longest) == ErrorCode::limit_exceeded);
  const Bytes png = plain_png(16, 16, {});
  for (std::size_t size = 0; size < 29; ++size)
    CHECK_FALSE(texture_edge(ByteView(png).first(size)).has_value());
}

TEST_CASE("uses of a texture ascend by material and have sides", "[textures]") {
  CHECK(check_texture_uses({{1, 1}, {65535, kAllTextureSides}}).has_value());
  CHECK_FALSE(check_texture_uses({}).has_value());
  CHECK_FALSE(check_texture_uses({{kEmpty, 1}}).has_value());
  CHECK_FALSE(check_texture_uses({{1, 0}}).has_value());
  CHECK_FALSE(check_texture_uses({{1, 64}}).has_value());
  CHECK_FALSE(check_texture_uses({{2, 1}, {2, 2}}).has_value());
  std::vector<TextureUse> many;
  for (std::size_t i = 0; i < kTextureUsesMax; ++i)
    many.push_back({static_cast<Material>(i + 1), 1});
  CHECK(check_texture_uses(many).has_value());
  many.push_back({60000, 1});
  CHECK_FALSE(check_texture_uses(many).has_value());
}

}  // namespace runstone::test
