// runstone-replay bench. The tests check what is measured, not the times.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "server/store/world_folder.hpp"
#include "tests/integration/server/replay/read_json.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

void make_world(const std::string& folder, std::size_t edits) {
  auto store = *create_world(folder, sample_meta());
  SplitMix64 rng(3);
  REQUIRE(store->raise_epoch().has_value());
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(store->append(players, sample_records(rng, 1, 1, edits)).has_value());
}

}  // namespace

TEST_CASE("the bench rebuilds what verify rebuilds, in every round", "[store][replay]") {
  const TempFolder folder;
  make_world(folder / "w", 300);
  const std::string world = folder / "w", bench = folder / "bench.json",
                    replay = folder / "replay.json";
  for (const std::string at : {"300", "120"}) {
    CAPTURE(at);
    const auto timed =
        run_replay({"bench", "--world", world, "--at", at, "--rounds", "3", "--json", bench});
    INFO(timed.out << timed.err);
    REQUIRE(timed.code == 0);
    REQUIRE(
        run_replay({"verify", "--quick", "--world", world, "--at", at, "--json", replay}).code ==
        0);
    const auto mine = read_json(bench), report = read_json(replay).at("report");
    CHECK(mine.at("seq") == std::stoi(at));
    for (const char* same : {"edits", "chunks", "voxels_changed", "stack_depths", "world_digest"}) {
      CAPTURE(same);
      CHECK(mine.at(same) == report.at(same));
    }
    for (const char* part : {"read", "rebuild"}) {
      CAPTURE(part);
      auto seconds = mine.at(part).at("seconds").get<std::vector<double>>();
      REQUIRE(seconds.size() == 3);
      std::sort(seconds.begin(), seconds.end());
      CHECK(mine.at(part).at("median_seconds") == seconds[1]);
      CHECK(mine.at(part).at("edits_per_second") == Approx(std::stoi(at) / seconds[1]));
    }
  }
}

TEST_CASE("a world that cannot be read is not timed", "[store][replay]") {
  const TempFolder folder;
  const auto none = run_replay({"bench", "--world", folder / "none"});
  CHECK(none.code == 2);
  CHECK(none.out.empty());
}
