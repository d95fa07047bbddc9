#include "client/report/histogram_report.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace runstone;
using nlohmann::json;

TEST_CASE("the JSON of a histogram has every duration in a row or among the infinite ones",
          "[client_app]") {
  Histogram us;
  for (const std::int64_t value : {-3, 16'383, 16'384, 24'575, 24'576}) us.add(value);
  us.add_infinite();
  us.add_infinite();
  const json out = json::parse(histogram_json(us).dump());
  CHECK(out["rows"] ==
        json::parse("[[0, 1, 1], [12288, 16384, 1], [16384, 24576, 2], [24576, 32768, 1]]"));
  CHECK(out["infinite"] == 2);
  CHECK(out["below_zero"] == 1);
  CHECK(out["count"] == 7);
  CHECK(out["max"] == "infinite");
  std::uint64_t counted = out["infinite"];
  for (const json& row : out["rows"]) counted += row[2].get<std::uint64_t>();
  CHECK(counted == out["count"]);
  CHECK(json::parse(histogram_json(Histogram{}).dump())["rows"] == json::array());
}

TEST_CASE("the bars of a histogram have a line for each row and one for infinite values",
          "[client_app]") {
  Histogram us;
  for (int i = 0; i < 100; ++i) us.add(2'048);
  us.add(3'072);
  us.add_infinite();
  CHECK(histogram_bars(us) ==
        "  below     3.072 ms        100 ##################################################\n"
        "  below     4.096 ms          1 #\n"
        "  never                       1\n");
}
