#include "server/rollback/joined_after.hpp"

#include <catch2/catch.hpp>
#include <memory>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kDayUs = TimeUs{86'400} * 1'000'000, kStartUs = 1'000 * kDayUs;

/// Makes a world of four players. `days`: of the edits of author 1, 2, 3 and 4, in turn.
std::unique_ptr<Store> world_of_edits(const std::string& folder,
                                      const std::vector<AuthorId>& authors) {
  auto store = *create_world(folder, sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  std::vector<PlayerRow> players;
  for (AuthorId author = 1; author <= 4; ++author) players.push_back(sample_player(author));
  std::vector<EditRecord> records;
  for (const AuthorId author : authors) {
    const Sequence seq = records.size() + 1;
    EditRecord record;
    record.version = {1, seq};
    record.op = {author, 1, seq};
    record.time_us = kStartUs + static_cast<TimeUs>(seq) * kDayUs;  // the edit n is of day n
    record.edit = {SetVoxel{{1, 1, 1}}, {}, 1};
    records.push_back(record);
  }
  REQUIRE(store->append(players, records).has_value());
  return store;
}

std::vector<AuthorId> new_since_day(WorldReader& reader, int day) {
  const auto found = joined_after(reader, kStartUs + day * kDayUs + kDayUs / 2);
  REQUIRE(found.has_value());
  return *found;
}

}  // namespace

TEST_CASE("players whose first edit is later have joined later", "[rollback]") {
  const TempFolder folder;
  const auto store = world_of_edits(folder / "world", {1, 2, 1, 3, 1, 4, 2});
  using Authors = std::vector<AuthorId>;
  CHECK(new_since_day(*store, 0) == Authors{1, 2, 3, 4});
  CHECK(new_since_day(*store, 1) == Authors{2, 3, 4});
  CHECK(new_since_day(*store, 3) == Authors{3, 4});
  CHECK(new_since_day(*store, 4) == Authors{4});
  CHECK(new_since_day(*store, 6).empty());
}

TEST_CASE("a player with a smaller number than one who has built had joined before", "[rollback]") {
  // Player 2 comes before player 3, and builds for the first time after everybody.
  const TempFolder folder;
  const auto store = world_of_edits(folder / "world", {1, 3, 4, 2});
  using Authors = std::vector<AuthorId>;
  CHECK(new_since_day(*store, 2) == Authors{4});
  CHECK(new_since_day(*store, 3).empty());
}

}  // namespace runstone::test
