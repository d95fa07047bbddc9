#include "server/repair/page_file.hpp"

#include <catch2/catch.hpp>

#include "server/store/sqlite_backend.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

/// Returns the numbers of the pages of back references in the database of a closed world.
std::vector<std::uint32_t> pointer_maps(const std::string& folder) {
  auto pages = PageFile::open(folder);
  if (!pages) FAIL(pages.error().message());
  std::vector<std::uint32_t> maps;
  for (std::uint32_t number = 1; number <= pages->pages(); ++number) {
    const auto page = pages->page(number);
    REQUIRE(page.has_value());
    if (pages->is_pointer_map(number, *page)) maps.push_back(number);
  }
  CHECK(pages->damage().empty());
  return maps;
}

}  // namespace

TEST_CASE("pages of back references are known, and only these", "[repair]") {
  const TempFolder folder;
  {
    SplitMix64 rng(1);
    const auto store = *create_world(folder.path(), sample_meta());
    REQUIRE(store->raise_epoch().has_value());
    // Pages of 2 KiB have a page of back references for 409 others.
    for (Sequence first = 1; first < 8'000; first += 1'000)
      REQUIRE(store->append({}, sample_records(rng, 1, first, 1'000)).has_value());
    REQUIRE(store->complete_file().has_value());
  }
  const std::vector<std::uint32_t> maps = pointer_maps(folder.path());
  REQUIRE(maps.size() > 1);
  for (std::size_t i = 0; i < maps.size(); ++i) CHECK(maps[i] == 2 + i * 410);
  // A file of an earlier program has none of them.
  REQUIRE(raw_sql(folder / "world.sqlite",
                  "PRAGMA auto_vacuum = NONE; VACUUM; PRAGMA auto_vacuum") == "0");
  CHECK(pointer_maps(folder.path()).empty());
}

}  // namespace runstone::test
