#include "bench/network/sample_row.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/network/fleet.hpp"

using namespace runstone::bench;
using nlohmann::json;

TEST_CASE("a histogram's table has all samples, and a last line for those that never arrived",
          "[testbed]") {
  const std::vector<SampleRow> rows = {{0.5, 0.75, 1}, {2, 3, 150}, {16.384, 24.576, 40}};
  CHECK(histogram_table(rows, 9) ==
        "| from, below ms | samples | share, % | so far, % | |\n"
        "|---|---|---|---|---|\n"
        "| 0.500, 0.750 | 1 | 0.500 | 0.500 | # |\n"
        "| 2.000, 3.000 | 150 | 75.000 | 75.500 | ######################################## |\n"
        "| 16.384, 24.576 | 40 | 20.000 | 95.500 | ########### |\n"
        "| never | 9 | 4.500 | 100.000 | ### |\n");
  CHECK(histogram_table(rows, 0).find("never") == std::string::npos);
  CHECK(histogram_table({}, 0).find('#') == std::string::npos);
  CHECK(histogram_table({}, 2).find("| never | 2 | 100.000 | 100.000 | ####") != std::string::npos);
}

TEST_CASE("a fleet's report is read from its bots' report, with infinite latencies", "[testbed]") {
  const FleetReport seen = fleet_report(json::parse(
      R"({"seen_us": {"count": 5, "infinite": 1, "p50": 1500, "p90": "infinite", "p99": "infinite", "max": "infinite",
                      "rows": [[1024, 1536, 3], [16384, 24576, 1]]}})"));
  CHECK(seen.rows == std::vector<SampleRow>{{1.024, 1.536, 3}, {16.384, 24.576, 1}});
  CHECK(seen.samples == 5);
  CHECK(seen.never == 1);
  CHECK(seen.p50_ms == 1.5);
  CHECK(std::isinf(seen.p90_ms));
  CHECK(std::isinf(seen.max_ms));
  CHECK(fleet_report(json::parse(R"({"local_us": {"p50": 1500}})")).rows.empty());
}
