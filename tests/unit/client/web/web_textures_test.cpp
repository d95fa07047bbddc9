#include "client/web/web_textures.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <deque>
#include <map>
#include <vector>

#include "client/web/page.hpp"

namespace runstone::test {
namespace {

/// The page's part of the cache, as in page/textures.js. answer() carries out the lookups.
struct TexturePage {
  std::map<TextureHash, Bytes> pngs;
  std::deque<std::vector<TextureHash>> lookups;

  void answer(WebTextures& textures) {
    for (; !lookups.empty(); lookups.pop_front()) {
      for (std::size_t i = 0; i < lookups.front().size(); ++i) {
        const auto png = pngs.find(lookups.front()[i]);
        if (png != pngs.end()) textures.found(i, png->second);
      }
      textures.looked_up();
    }
  }
};
TexturePage* texture_page = nullptr;  // of the test that runs

}  // namespace
}  // namespace runstone::test

extern "C" {

void page_textures_find(const std::uint8_t* hashes, int count) {
  auto& wanted = runstone::test::texture_page->lookups.emplace_back();
  for (int i = 0; i < count; ++i, hashes += sizeof(runstone::TextureHash)) {
    runstone::TextureHash hash;
    std::copy(hashes, hashes + hash.size(), hash.begin());
    wanted.push_back(hash);
  }
}

void page_textures_keep(const std::uint8_t* rows, int bytes) {
  runstone::ByteReader in{runstone::ByteView(rows, static_cast<std::size_t>(bytes))};
  while (in.left() != 0) {
    runstone::TextureHash hash;
    const auto head = in.bytes(hash.size());
    std::copy(head.begin(), head.end(), hash.begin());
    const auto png = in.bytes(in.u32());
    runstone::test::texture_page->pngs[hash] = {png.begin(), png.end()};
  }
  REQUIRE(in.ok());
}

}  // extern "C"

namespace runstone::test {

TEST_CASE("the page finds the pictures that it keeps", "[web][textures]") {
  TexturePage store;
  texture_page = &store;
  WebTextures textures;
  const std::vector<TexturePart> parts = {{{1}, Bytes(300, 5)}, {{2}, Bytes(1, 6)}};
  textures.keep_textures(parts);
  CHECK(store.pngs.size() == 2);
  textures.look_up_textures({{2}, {3}, {1}});
  textures.look_up_textures({{3}});
  CHECK(textures.drain_textures().empty());
  store.answer(textures);
  const auto results = textures.drain_textures();
  REQUIRE(results.size() == 2);
  CHECK(results[0] == std::vector{parts[1], parts[0]});
  CHECK(results[1].empty());
  // Calls that do not fit a lookup are ignored, and so is a row that is too large.
  textures.found(0, parts[0].png);
  textures.looked_up();
  textures.look_up_textures({{1}});
  textures.found(1, parts[0].png);
  textures.found(0, Bytes(kTextureBytesMax + 1));
  textures.looked_up();
  const auto none = textures.drain_textures();
  REQUIRE(none.size() == 1);
  CHECK(none[0].empty());
  texture_page = nullptr;
}

}  // namespace runstone::test
