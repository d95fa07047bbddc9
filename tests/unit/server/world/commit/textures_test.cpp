// Textures that are given while people play: who gets the list, and what is refused.
#include <catch2/catch.hpp>
#include <memory>

#include "common/textures/texture_hash.hpp"
#include "server/world/commit/changes.hpp"
#include "tests/support/textures/test_png.hpp"
#include "tests/unit/server/world/commit/feature_bench.hpp"

namespace runstone::test {
namespace {

GivenTexturePtr given_of(std::uint8_t colour, std::vector<TextureUse> uses) {
  return std::make_shared<const GivenTexture>(
      GivenTexture{plain_png(16, 16, {colour, 0, 0, 255}), std::move(uses)});
}

TextureEntry entry_of(const GivenTexturePtr& given) {
  return texture_entry(given->png, given->uses);
}

struct TextureBench : FeatureBench {
  using FeatureBench::FeatureBench;

  std::vector<TextureEntry> list_of(SessionId session) const {
    std::vector<TextureEntry> entries;
    for (const TexturesGiven& m : environment.messages<TexturesGiven>(session, kEdge))
      entries.insert(entries.end(), m.entries.begin(), m.entries.end());
    return entries;
  }
  Result<Sequence, std::string> give(const std::vector<GivenTexturePtr>& textures) {
    return server.changes().give_textures(textures, now());
  }
};

}  // namespace

TEST_CASE("given textures are records, and the list reaches the sessions with the feature",
          "[world][textures]") {
  TextureBench bench;
  bench.join_with(1, 1, kFeatureMaterials | kFeatureTextures);
  bench.join_with(2, 2, kFeatureMaterials);
  const auto first = given_of(1, {{1, 63}}), second = given_of(2, {{2, 1}, {3, 62}});
  const auto seq = bench.give({first, second});
  REQUIRE(seq.has_value());
  CHECK(*seq == 2);
  const EditRecord& record = bench.environment.records.back();
  CHECK(record.cause == Cause::textures);
  CHECK(record.op.author == 0);
  CHECK(validate_fields(record).has_value());
  CHECK(*given_texture_of(record.edit) == *second);
  const std::vector<TextureEntry> all = {entry_of(first), entry_of(second)};
  CHECK(bench.list_of(1) == all);
  CHECK(bench.list_of(2).empty());
  CHECK(bench.environment.closed.empty());

  // A session that joins later gets the whole list, and afterwards the new textures.
  bench.join_with(3, 3, kFeatureMaterials | kFeatureTextures);
  CHECK(bench.list_of(3) == all);
  const auto third = given_of(1, {{2, 2}});
  REQUIRE(bench.give({third}).has_value());
  CHECK(bench.list_of(3).size() == 3);
  CHECK(bench.list_of(3).back() == entry_of(third));
  CHECK(bench.server.order().textures().table().entries().size() == 2);
}

TEST_CASE("a log without room for all textures takes none, and one commit takes all of them",
          "[world][textures]") {
  TextureBench bench;
  std::vector<GivenTexturePtr> textures;
  for (std::uint8_t i = 0; i < 4; ++i)
    textures.push_back(given_of(i, {{static_cast<Material>(i + 1), 63}}));
  bench.environment.log_records_max = textures.size() - 1;
  CHECK_FALSE(bench.give(textures).has_value());
  CHECK(bench.environment.records.empty());
  CHECK(bench.server.order().textures().table().empty());
  bench.environment.log_records_max = textures.size();
  const auto commits = bench.server.counters().commits;
  REQUIRE(bench.give(textures).has_value());
  CHECK(bench.environment.records.size() == textures.size());
  CHECK(bench.server.counters().commits == commits + 1);
}

TEST_CASE("a second picture for a side is refused, and so are unknown materials",
          "[world][textures]") {
  TextureBench bench;
  REQUIRE(bench.give({given_of(1, {{1, 1}})}).has_value());
  const std::size_t records = bench.environment.records.size();
  const auto again = bench.give({given_of(2, {{2, 1}}), given_of(3, {{1, 63}})});
  REQUIRE_FALSE(again.has_value());
  const std::string name = bench.server.order().materials()[1].name;
  CHECK(again.error() == "a side of \"" + name + "\" has a picture already, which stays for ever");
  CHECK(bench.give({given_of(2, {{60000, 1}})}).error() == "the world has no material 60000");
  CHECK(bench.environment.records.size() == records);
  CHECK(bench.server.order().textures().table().number(2, Direction::neg_x) == 0);
}

}  // namespace runstone::test
