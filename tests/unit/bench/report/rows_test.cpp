#include "tests/bench/report/rows.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/bench/report/data_table.hpp"

namespace runstone::bench {
namespace {

const nlohmann::json kRows = nlohmann::json::parse(R"([
  {"mesher": "rdm", "part": "1", "ns": 10, "edge": 32},
  {"mesher": "rdm", "part": "2", "ns": 40, "edge": 64},
  {"mesher": "simple", "part": "1", "ns": null, "edge": 32},
  "no row"])");

TEST_CASE("rows are selected by text and number, and missing values are not measured") {
  const Rows rows(kRows);
  CHECK(rows.size() == 3);
  CHECK(rows.where("mesher", "rdm").size() == 2);
  CHECK(rows.where("mesher", "rdm").where("edge", 64).number("ns") == 40);
  CHECK(rows.kinds("mesher") == std::vector<std::string>{"rdm", "simple"});
  CHECK(std::isnan(rows.where("mesher", "simple").number("ns")));
  CHECK(std::isnan(rows.number("nothing")));
  CHECK(std::isnan(rows.where("mesher", "none").number("ns")));
  CHECK(rows.where("mesher", "none").text("part").empty());
  CHECK(Rows(nlohmann::json(3)).empty());
}

TEST_CASE("means leave out missing values") {
  const double none = std::nan("");
  CHECK(mean_of({1, none, 3}) == 2);
  CHECK(sum_of({1, none, 3}) == 4);
  CHECK(geometric_mean_of({1, none, 100, 0}) == Approx(10));
  CHECK(std::isnan(mean_of({none})));
  CHECK(std::isnan(geometric_mean_of({})));
}

TEST_CASE("a table is CSV with quotes where they are needed") {
  DataTable table{{"name", "value"}, {}};
  table.add({"plain", 1'195'306.5});
  table.add({"a \"b\", c", std::nan("")});
  CHECK(csv_of(table) == "name,value\r\nplain,1195306.5\r\n\"a \"\"b\"\", c\",\r\n");
}

}  // namespace
}  // namespace runstone::bench
