#include "server/history/moments.hpp"

#include <catch2/catch.hpp>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {

TEST_CASE("cancelled moments end their reads, and the log is not read to the end", "[history]") {
  constexpr Sequence kEdits = 2 * WorldAt::kProgressEdits;
  const TempFolder folder;
  auto store = *create_world(folder.path(), sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  SplitMix64 rng(1);
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(store->append(players, sample_records(rng, 1, 1, kEdits)).has_value());
  const auto generator = *make_generator(store->meta().generator, store->meta().materials);
  Moments moments(folder.path(), *generator);
  CHECK(moments.open(5).has_value());
  moments.cancel();
  const auto chunk = moments.chunk(5, {0, {0, 0, 0}});  // of a moment that is open
  REQUIRE_FALSE(chunk.has_value());
  CHECK(chunk.error().kind == StoreError::Kind::cancelled);
  const auto opened = moments.open(kEdits);
  REQUIRE_FALSE(opened.has_value());
  CHECK(opened.error().kind == StoreError::Kind::cancelled);
}

}  // namespace runstone::test
