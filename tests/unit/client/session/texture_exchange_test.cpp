// Tests how a session gets the textures of a world: from the cache, from the server, and with
// damaged data.
#include "client/session/texture_exchange.hpp"

#include "client/render/image.hpp"
#include "common/core/hash.hpp"
#include "common/textures/texture_hash.hpp"
#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test {

using namespace session_bench;

namespace {

/// Returns the PNG of a picture of one colour.
Bytes png_of(std::uint8_t red, int edge = 16) {
  Image image{edge, edge, {}};
  image.rgb.assign(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge) * 3, red);
  return encode_png(image);
}

TextureEntry entry_of(const Bytes& png, Material material) {
  return {texture_hash(png), static_cast<std::uint32_t>(png.size()), {{material, 1}}};
}

/// A cache, as exchange_textures() uses it.
struct FakeTextureCache {
  std::vector<std::vector<TextureHash>> lookups;
  std::vector<std::vector<TexturePart>> results;
  std::map<TextureHash, Bytes> kept;

  std::vector<std::vector<TexturePart>> drain_textures() { return std::exchange(results, {}); }
  void look_up_textures(std::vector<TextureHash> hashes) { lookups.push_back(std::move(hashes)); }
  void keep_textures(const std::vector<TexturePart>& parts) {
    for (const TexturePart& part : parts) kept[part.hash] = part.png;
  }
  void answer() {
    for (const auto& hashes : std::exchange(lookups, {})) {
      std::vector<TexturePart> found;
      for (const TextureHash& hash : hashes) {
        if (kept.contains(hash)) found.push_back({hash, kept[hash]});
      }
      results.push_back(std::move(found));
    }
  }
};

struct TextureSession : SessionBench {
  TextureSession() { use(true); }
  void use(bool has_cache) {
    SessionConfig made = config();
    made.has_cache = has_cache;
    session = ClientSession(made);
    session.textures().set_wanted(true);
    server.features = kFeatureTextures;
  }
  void give(const std::vector<Bytes>& pngs) {
    TexturesGiven given;
    for (const Bytes& png : pngs)
      given.entries.push_back(entry_of(png, static_cast<Material>(++materials)));
    receive(given);
  }
  /// A turn of the client. Returns the hashes that it asks the server for.
  std::vector<TextureHash> turn() {
    exchange_textures(session.textures(), cache);
    cache.answer();
    exchange_textures(session.textures(), cache);
    session.tick(now);
    exchange_textures(session.textures(), cache);
    std::vector<TextureHash> out;
    for (const TexturesWanted& wanted : take<TexturesWanted>(sent())) {
      REQUIRE_FALSE(wanted.hashes.empty());
      REQUIRE(wanted.hashes.size() <= kTexturesWantedMax);
      out.insert(out.end(), wanted.hashes.begin(), wanted.hashes.end());
    }
    return out;
  }
  void answer(const std::vector<Bytes>& pngs) {
    TextureParts parts;
    for (const Bytes& png : pngs) parts.parts.push_back({texture_hash(png), png});
    receive(parts);
  }
  TexturePicturePtr picture(const Bytes& png) const {
    return session.textures().picture(texture_hash(png));
  }

  FakeTextureCache cache;
  unsigned materials = 0;
};

}  // namespace

TEST_CASE_METHOD(TextureSession, "pictures come from the server, and the next time from the cache",
                 "[session][textures]") {
  const std::vector<Bytes> pngs = {png_of(10), png_of(20, 64), png_of(30)};
  static_cast<void>(open());
  CHECK((server.hello.features & kFeatureTextures) != 0);
  give(pngs);
  CHECK(session.textures().is_loading());
  const auto wanted = turn();
  REQUIRE(wanted.size() == 3);
  CHECK(turn().empty());  // they are under way
  answer(pngs);
  CHECK(turn().empty());
  CHECK_FALSE(session.textures().is_loading());
  CHECK(session.textures().table().entries().size() == 3);
  for (const Bytes& png : pngs) REQUIRE(picture(png));
  CHECK(picture(pngs[1])->edge == 64);
  CHECK(picture(pngs[0])->rgba[0] == 10);
  CHECK(cache.kept.size() == 3);

  SECTION("another run of the client asks for nothing") {
    use(true);
    materials = 0;
    static_cast<void>(open());
    give(pngs);
    CHECK(turn().empty());
    CHECK_FALSE(session.textures().is_loading());
    for (const Bytes& png : pngs) CHECK(picture(png));
  }
  SECTION("another connection keeps the pictures, and gets the list again") {
    session.disconnected();
    CHECK(session.textures().table().entries().size() == 3);
    static_cast<void>(open());
    materials = 0;
    const std::uint64_t serial = session.textures().serial();
    give({pngs[0], pngs[1]});
    CHECK(session.textures().serial() != serial);
    CHECK(session.textures().table().entries().size() == 2);
    CHECK(turn().empty());
    CHECK(picture(pngs[1]));
  }
  SECTION("another world forgets them") {
    session.disconnected();
    server.world_id = {7};
    static_cast<void>(open());
    CHECK(session.textures().table().empty());
    CHECK_FALSE(picture(pngs[0]));
  }
  SECTION("a damaged row of the cache is asked for again, and replaced") {
    cache.kept[texture_hash(pngs[0])][30] ^= 1;
    cache.kept[texture_hash(pngs[2])].pop_back();
    use(true);
    materials = 0;
    static_cast<void>(open());
    give(pngs);
    CHECK(turn().size() == 2);
    answer(pngs);
    static_cast<void>(turn());
    static_cast<void>(turn());
    CHECK_FALSE(session.textures().is_loading());
    CHECK(session.textures().failed() == 0);
    CHECK(cache.kept[texture_hash(pngs[0])] == pngs[0]);
    CHECK(cache.kept[texture_hash(pngs[2])] == pngs[2]);
  }
}

TEST_CASE_METHOD(TextureSession,
                 "nothing is asked for while textures are off or without the feature",
                 "[session][textures]") {
  const std::vector<Bytes> pngs = {png_of(1), png_of(2)};
  use(GENERATE(false, true));
  session.textures().set_wanted(false);
  static_cast<void>(open());
  give(pngs);
  CHECK(turn().empty());
  CHECK(cache.lookups.empty());
  CHECK_FALSE(session.textures().is_loading());
  session.textures().set_wanted(true);
  CHECK(turn().size() == 2);
  answer(pngs);
  static_cast<void>(turn());
  CHECK(picture(pngs[0]));

  session.disconnected();
  server.features = 0;
  static_cast<void>(open());
  CHECK(turn().empty());
  give({png_of(3)});  // without the feature
  REQUIRE(session.end().has_value());
  CHECK(session.end()->reason == GoodbyeReason::unexpected_message);
}

TEST_CASE_METHOD(TextureSession, "pictures with other bytes than the list says are not decoded",
                 "[session][textures]") {
  const Bytes good = png_of(1), other = png_of(2), text(400, 'x'), unsent = png_of(3);
  static_cast<void>(open());
  give({good, other, text, unsent});
  REQUIRE(turn().size() == 4);
  TextureParts parts;
  parts.parts.push_back({texture_hash(good), good});
  parts.parts.push_back({texture_hash(other), good});           // another hash
  parts.parts.push_back({texture_hash(text), text});            // no picture
  parts.parts.push_back({texture_hash(unsent), {}});            // the server does not send it
  parts.parts.push_back({texture_hash(png_of(9)), png_of(9)});  // nobody asked for it
  receive(parts);
  CHECK(turn().empty());
  CHECK(turn().empty());  // they are not asked for again
  CHECK(session.is_open());
  CHECK(session.textures().failed() == 3);
  CHECK_FALSE(session.textures().is_loading());
  CHECK(picture(good));
  CHECK_FALSE(picture(other));
  CHECK_FALSE(picture(text));
  CHECK_FALSE(picture(png_of(9)));
  CHECK(cache.kept.size() == 1);
  // A second answer to one hash changes nothing.
  answer({other});
  static_cast<void>(turn());
  CHECK_FALSE(picture(other));
  // Another connection asks again.
  session.disconnected();
  materials = 0;
  static_cast<void>(open());
  give({good, other, text, unsent});
  CHECK(turn().size() == 3);
}

TEST_CASE_METHOD(TextureSession, "a list that is not valid ends the session",
                 "[session][textures]") {
  static_cast<void>(open());
  give({png_of(1)});
  TexturesGiven wrong{{entry_of(png_of(2), 2)}};
  SECTION("a side that has a picture") { wrong.entries[0].uses[0].material = 1; }
  SECTION("no sides") { wrong.entries[0].uses[0].sides = 0; }
  SECTION("a picture that is too large") { wrong.entries[0].bytes = kTextureBytesMax + 1; }
  SECTION("one picture with two sizes") {
    wrong.entries[0].hash = texture_hash(png_of(1));
    wrong.entries[0].bytes = static_cast<std::uint32_t>(png_of(1).size()) + 1;
  }
  SECTION("too many pictures") {
    wrong.entries.clear();
    for (std::size_t i = 0; i < kTextureCountMax; ++i) {
      TextureEntry entry = entry_of(png_of(2), static_cast<Material>(i + 2));
      entry.hash[0] = static_cast<std::uint8_t>(i);
      entry.hash[1] = static_cast<std::uint8_t>(i >> 8);
      wrong.entries.push_back(entry);
    }
  }
  SECTION("too many bytes") {
    wrong.entries.clear();
    for (std::size_t i = 0; i <= kTexturesBytesMax / kTextureBytesMax; ++i) {
      TextureEntry entry = entry_of(png_of(2), static_cast<Material>(i + 2));
      entry.bytes = kTextureBytesMax;
      entry.hash[0] = static_cast<std::uint8_t>(i);
      entry.hash[1] = static_cast<std::uint8_t>(i >> 8);
      wrong.entries.push_back(entry);
    }
  }
  receive(wrong);
  REQUIRE(session.end().has_value());
  CHECK(session.end()->reason == GoodbyeReason::malformed_message);
  CHECK_FALSE(session.end()->final);
}

TEST_CASE_METHOD(TextureSession,
                 "many pictures are asked for one request after the other, and decoded in parts",
                 "[session][textures]") {
  const bool has_cache = GENERATE(false, true);
  use(has_cache);
  std::vector<Bytes> pngs;
  for (int i = 0; i < 250; ++i) {
    Image image{16, 16, {}};
    for (int at = 0; at < 16 * 16 * 3; ++at)
      image.rgb.push_back(
          static_cast<std::uint8_t>(mix64(static_cast<std::uint64_t>(i * 1000 + at))));
    pngs.push_back(encode_png(image));
  }
  static_cast<void>(open());
  give(pngs);
  std::map<TextureHash, Bytes> by_hash;
  for (const Bytes& png : pngs) by_hash[texture_hash(png)] = png;
  std::size_t asked = 0, requests = 0, turns = 0;
  while (session.textures().is_loading() && ++turns < 100) {
    const auto wanted = turn();
    requests += wanted.empty() ? 0 : 1;
    asked += wanted.size();
    TextureParts parts;
    for (const TextureHash& hash : wanted) parts.parts.push_back({hash, by_hash[hash]});
    if (!wanted.empty()) receive(parts);
  }
  CHECK(requests == 3);
  CHECK(asked == 250);
  CHECK(turns > 250 * 800 / TextureExchange::kDecodeBytes);  // one turn does not decode all
  CHECK(session.textures().failed() == 0);
  for (const Bytes& png : pngs) CHECK(picture(png));
  CHECK(cache.kept.size() == (has_cache ? 250U : 0U));
}

}  // namespace runstone::test
