// Pictures that clients want: each is answered, a few times, and floods end.
#include "server/world/library/texture_sending.hpp"

#include <catch2/catch.hpp>
#include <memory>

#include "common/textures/texture_hash.hpp"
#include "tests/support/textures/test_png.hpp"
#include "tests/unit/server/world/commit/feature_bench.hpp"

namespace runstone::test {
namespace {

struct SendingBench : FeatureBench {
  SendingBench() {
    for (std::uint8_t i = 0; i < 4; ++i) {
      Bytes png = plain_png(16, 16, {i, 0, 0, 255});
      if (i == 3) png.resize(kTextureBytesMax);
      hashes.push_back(texture_hash(png));
      textures.push_back(std::make_shared<const GivenTexture>(
          GivenTexture{std::move(png), {{1, static_cast<std::uint8_t>(1U << i)}}}));
    }
    REQUIRE(server.changes().give_textures(textures, now()).has_value());
    join_with(1, 1, kFeatureMaterials | kFeatureTextures);
  }
  std::vector<TexturePart> parts_of(SessionId session) const {
    std::vector<TexturePart> parts;
    for (const TextureParts& m : environment.messages<TextureParts>(session, kEdge))
      parts.insert(parts.end(), m.parts.begin(), m.parts.end());
    return parts;
  }
  void want(const std::vector<TextureHash>& wanted) {
    server.received(1, TexturesWanted{wanted}, now());
  }

  std::vector<TextureHash> hashes;
  std::vector<GivenTexturePtr> textures;
};

}  // namespace

TEST_CASE("every wanted hash is answered in order, unknown ones without a picture",
          "[world][textures]") {
  SendingBench bench;
  bench.want({bench.hashes[2], TextureHash{9}, bench.hashes[3], bench.hashes[0]});
  const auto parts = bench.parts_of(1);
  REQUIRE(parts.size() == 4);
  CHECK(parts[0].hash == bench.hashes[2]);
  CHECK(parts[0].png == bench.textures[2]->png);
  CHECK(parts[1].hash == TextureHash{9});
  CHECK(parts[1].png.empty());
  CHECK(parts[2].png.size() == kTextureBytesMax);
  CHECK(parts[3].png == bench.textures[0]->png);
  // The large one does not fit behind the first ones.
  CHECK(bench.environment.messages<TextureParts>(1, kEdge).size() == 3);
}

TEST_CASE("a picture is sent a few times to a session", "[world][textures]") {
  SendingBench bench;
  for (int i = 0; i < kTextureAnswersMax + 2; ++i) bench.want({bench.hashes[0]});
  const auto parts = bench.parts_of(1);
  REQUIRE(parts.size() == kTextureAnswersMax + 2);
  for (std::size_t i = 0; i < parts.size(); ++i)
    CHECK(parts[i].png.empty() == (i >= kTextureAnswersMax));
  CHECK(bench.environment.closed.empty());
}

TEST_CASE("a session with too many unanswered hashes is closed, and others are answered in order",
          "[world][textures]") {
  SendingBench bench;
  bench.join_with(2, 2, kFeatureMaterials | kFeatureTextures);
  bench.environment.full = {1, 2};
  std::vector<TextureHash> all;
  for (std::uint8_t i = 0; i < kTexturesUnansweredMax; ++i) {
    TextureHash hash{};
    hash[0] = i;
    all.push_back(i % 64 == 5 ? bench.hashes[i / 64] : hash);
  }
  const std::vector<TextureHash> first(all.begin(), all.begin() + kTexturesWantedMax),
      second(all.begin() + kTexturesWantedMax, all.end());
  for (const SessionId session : {1U, 2U}) {
    bench.server.received(session, TexturesWanted{first}, bench.now());
    bench.server.received(session, TexturesWanted{second}, bench.now());
  }
  CHECK(bench.environment.closed.empty());
  bench.server.received(2, TexturesWanted{{TextureHash{255}}}, bench.now());
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].session == 2);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::flooding);
  CHECK(bench.parts_of(1).empty());
  bench.environment.full.clear();
  bench.tick();
  const auto parts = bench.parts_of(1);
  REQUIRE(parts.size() == all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(parts[i].hash == all[i]);
    CHECK(parts[i].png.empty() == (i % 64 != 5));
  }
  CHECK(bench.environment.closed.size() == 1);
}

TEST_CASE("a message that finds the queue full is kept and sent once", "[world][textures]") {
  SendingBench bench;
  bench.environment.full.insert(1);
  bench.want({bench.hashes[0], bench.hashes[1]});
  for (int i = 0; i < 3; ++i) bench.tick();
  std::vector<std::shared_ptr<const Bytes>> kept;
  for (const auto& [session, message] : bench.environment.unsent) {
    if (message.kind == kKindOf<TextureParts>) kept.push_back(message.bytes);
  }
  REQUIRE(kept.size() >= 2);
  CHECK(kept.front() == kept.back());  // it was encoded once
  CHECK(bench.parts_of(1).empty());
  bench.environment.full.clear();
  bench.tick();
  const auto parts = bench.parts_of(1);
  REQUIRE(parts.size() == 2);
  CHECK(parts[0].png == bench.textures[0]->png);
  CHECK(parts[1].png == bench.textures[1]->png);
  bench.tick();
  CHECK(bench.parts_of(1).size() == 2);
}

TEST_CASE("pictures of a message that waits are unanswered", "[world][textures]") {
  SendingBench bench;
  bench.environment.full.insert(1);
  const std::vector<TextureHash> many(kTexturesWantedMax, bench.hashes[0]);
  bench.want(many);
  bench.want(many);
  CHECK(bench.environment.closed.empty());
  bench.want({bench.hashes[1]});
  CHECK(bench.environment.closed.size() == 1);
}

TEST_CASE("a client that wants textures without the feature is closed", "[world][textures]") {
  SendingBench bench;
  bench.join_with(2, 2, kFeatureMaterials);
  bench.server.received(2, TexturesWanted{{bench.hashes[0]}}, bench.now());
  CHECK(bench.environment.closed.size() == 1);
}

}  // namespace runstone::test
