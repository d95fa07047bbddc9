#include "client/play/texture_feed.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "client/render/image.hpp"
#include "common/textures/texture_hash.hpp"

namespace runstone {
namespace {

Bytes png_of_edge(std::uint8_t red, int edge) {
  Image image{edge, edge, {}};
  image.rgb.assign(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge) * 3, red);
  return encode_png(image);
}

/// An exchange of textures whose server is the test.
struct TextureWorld {
  TextureWorld() {
    exchange.set_wanted(true);
    exchange.connected(true, false);
  }
  void give(const Bytes& png) {
    TextureEntry entry{texture_hash(png), static_cast<std::uint32_t>(png.size()), {}};
    entry.uses = {{++material, kAllTextureSides}};
    REQUIRE(exchange.receive(TexturesGiven{{entry}}).has_value());
  }
  void answer(const Bytes& png) {
    exchange.receive(TextureParts{{{texture_hash(png), png}}});
    static_cast<void>(exchange.step());
  }
  std::optional<DrawnTexturesPtr> step(bool is_on = true) {
    return textures.step(exchange, is_on, now);
  }

  TextureExchange exchange;
  TextureFeed textures;
  TimeUs now = 1'000'000;
  Material material = kEmpty;
};

}  // namespace

TEST_CASE("pictures are drawn in batches as they arrive, and all of them in the end",
          "[play][textures]") {
  TextureWorld world;
  CHECK_FALSE(world.step());
  const std::vector<Bytes> pngs = {png_of_edge(1, 16), png_of_edge(2, 16), png_of_edge(3, 32)};
  for (const Bytes& png : pngs) world.give(png);
  CHECK_FALSE(world.step());  // there is nothing to draw yet
  REQUIRE(world.exchange.step().size() == 1);
  world.answer(pngs[0]);
  const auto first = world.step();
  REQUIRE(first);
  REQUIRE(*first);
  REQUIRE((*first)->pictures.size() == 3);
  CHECK((*first)->pictures[0]);
  CHECK_FALSE((*first)->pictures[1]);
  world.answer(pngs[1]);
  CHECK_FALSE(world.step());
  world.now += TextureFeed::kBatchUs;
  CHECK(world.step());
  world.answer(pngs[2]);
  const auto last = world.step();  // nothing is under way, so it does not wait
  REQUIRE(last);
  for (const TextureLevelsPtr& picture : (*last)->pictures) CHECK(picture);
  CHECK((*last)->pictures[0] == (*first)->pictures[0]);  // it is not made again
  CHECK((*last)->table->number(3, Direction::pos_y) == 3);
  CHECK(world.exchange.picture_bytes() == (16 * 16 + 16 * 16 + 32 * 32) * 4);
  CHECK(world.textures.bytes() ==
        2 * (256 + 64 + 16 + 4 + 1) * 4 + (1024 + 256 + 64 + 16 + 4 + 1) * 4);
  CHECK_FALSE(world.step());
}

TEST_CASE("textures that are turned off are removed, and drawn again when turned on",
          "[play][textures]") {
  TextureWorld world;
  const Bytes png = png_of_edge(9, 16);
  world.give(png);
  static_cast<void>(world.exchange.step());
  world.answer(png);
  REQUIRE(world.step());
  const auto off = world.step(false);
  REQUIRE(off);
  CHECK_FALSE(*off);
  CHECK_FALSE(world.step(false));
  const auto on = world.step();
  REQUIRE(on);
  CHECK(*on);
  // Another world has no textures.
  world.exchange.clear();
  const auto gone = world.step();
  REQUIRE(gone);
  CHECK_FALSE(*gone);
}

TEST_CASE("one step prepares a bounded number of pixels", "[play][textures]") {
  TextureWorld world;
  std::vector<Bytes> pngs;
  for (std::uint8_t i = 0; i < 40; ++i) pngs.push_back(png_of_edge(i, 64));
  for (const Bytes& png : pngs) world.give(png);
  static_cast<void>(world.exchange.step());
  for (const Bytes& png : pngs) world.answer(png);
  REQUIRE_FALSE(world.exchange.is_loading());
  std::size_t steps = 1;
  auto drawn = world.step();
  for (; !drawn && steps < 100; ++steps) drawn = world.step();
  REQUIRE(drawn);
  CHECK(steps == 40 * 64 * 64 / TextureFeed::kPixels + 1);
  for (const TextureLevelsPtr& picture : (*drawn)->pictures) CHECK(picture);
}

TEST_CASE("the player reads once what is wrong with textures", "[play][textures]") {
  TextureWorld world;
  const Bytes png = png_of_edge(9, 16);
  world.give(png);
  static_cast<void>(world.exchange.step());
  CHECK_FALSE(world.textures.take_notice(world.exchange, 0));
  world.exchange.receive(TextureParts{{{texture_hash(png), png_of_edge(8, 16)}}});
  static_cast<void>(world.exchange.step());
  const auto failed = world.textures.take_notice(world.exchange, 0);
  REQUIRE(failed);
  CHECK(failed->starts_with("1 texture of this world is not drawn: the server sent"));
  CHECK_FALSE(world.textures.take_notice(world.exchange, 0));
  const auto left_out = world.textures.take_notice(world.exchange, 5);
  REQUIRE(left_out);
  CHECK(left_out->starts_with("5 textures of this world are not drawn: the graphics driver"));
  CHECK_FALSE(world.textures.take_notice(world.exchange, 5));
}

TEST_CASE("the player reads what is wrong with the textures of the next world, too",
          "[play][textures]") {
  TextureWorld world;
  const Bytes png = png_of_edge(9, 16);
  for (int i = 0; i < 2; ++i) {
    CAPTURE(i);
    world.exchange.clear();
    world.exchange.connected(true, false);
    world.material = kEmpty;
    world.give(png);
    static_cast<void>(world.exchange.step());
    REQUIRE(world.exchange.is_loading());
    CHECK_FALSE(world.textures.take_notice(world.exchange, 0));
    world.exchange.receive(TextureParts{{{texture_hash(png), png_of_edge(8, 16)}}});
    static_cast<void>(world.exchange.step());
    CHECK(world.textures.take_notice(world.exchange, 0));
  }
}

}  // namespace runstone
