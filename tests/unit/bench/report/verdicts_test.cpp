// The verdicts follow from the numbers, whichever mesher wins.
#include "tests/bench/report/verdicts.hpp"

#include <catch2/catch.hpp>

#include "common/generate/scenarios/scenario_model.hpp"
#include "tests/bench/report/mesher_totals.hpp"
#include "tests/bench/report/number_text.hpp"
#include "tests/bench/report/summary.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text_contains.hpp"

namespace runstone::bench {
namespace {

using test::contains;

/// Each mesher takes the same time in every scenario, except that the product takes 500 ns in the
/// last.
Finding meshers_of(double ours_ns, double dense_ns) {
  nlohmann::json rows = nlohmann::json::array();
  for (unsigned s = 1; s <= kScenarioCount; ++s) {
    const auto add = [&](const char* mesher, double ns, int triangles) {
      rows.push_back({{"part", std::to_string(s)},
                      {"mesher", mesher},
                      {"median_ns", ns},
                      {"triangles", triangles},
                      {"t_junctions", triangles / 2}});
    };
    add("rdm", s == kScenarioCount ? 500 : ours_ns, 12);
    add("decode_binary", dense_ns, 10);
    add("optimal_greedy", 9000, 10);
    if (s != 3) add("simple", 1, 1);  // skipped in one
  }
  return {"meshers",
          {"a cpu", 2, "g++ 12", "abc", "AVX2"},
          true,
          "a world",
          "2026-01-31T23:59:59Z",
          1,
          {{"rows", rows}}};
}

struct ReportTexts {
  Verdicts verdicts;
  std::string summary;
};

ReportTexts texts_of(const Finding& finding) {
  const test::TempFolder folder;
  REQUIRE(write_finding(folder / "out", finding).has_value());
  const auto findings = Findings::read(folder / "out", {"meshers", "facts"}, {});
  const ThesisData thesis;
  return {verdicts_of({findings, thesis}), summary_of({findings, thesis})};
}

TEST_CASE("where runs are faster, the answer says so, by both means, and where they are not") {
  const auto [verdicts, summary] = texts_of(meshers_of(100, 200));
  INFO(verdicts.answer << summary);
  CHECK(contains(verdicts.answer, "starts from the stored runs is Run Directional Meshing."));
  CHECK(contains(verdicts.answer, "takes 1.91 times as long"));  // (2^36 * 0.4)^(1/37)
  CHECK(contains(verdicts.answer, "and 1.8 times by the sum"));  // 37 * 200 / (36 * 100 + 500)
  CHECK(contains(verdicts.answer, "faster in 36 of the 37 scenarios; the exceptions are 37."));
  CHECK(contains(
      summary,
      "Doubt: Not measured: landscapes, facts, bytes, transfer-loopback, transfer-broadband."));
  CHECK(contains(summary, "quick run"));
}

TEST_CASE("where runs are slower, the answer says so") {
  const auto [verdicts, summary] = texts_of(meshers_of(400, 200));
  INFO(verdicts.answer);
  CHECK(contains(verdicts.answer, "starts from the stored runs is binary greedy."));
  CHECK(contains(verdicts.answer, "faster in 0 of the 37 scenarios"));
}

TEST_CASE("equals share a place, and a mesher that was not measured everywhere has none") {
  const auto [verdicts, summary] = texts_of(meshers_of(100, 200));
  REQUIRE(verdicts.rows.size() == 3);
  CHECK(verdicts.rows[0].winner == "ours: RDM from runs: 104 ns");  // 100 * 5^(1/37)
  CHECK(verdicts.rows[1].winner == "decode + binary greedy: 370");
  CHECK(verdicts.rows[2].winner == "decode + binary greedy, optimal greedy (grid ready): 185");
  CHECK(verdicts.rows[2].loser == "ours: RDM from runs: 222");
  CHECK_FALSE(contains(summary, "simple"));
}

TEST_CASE("numbers are written in full, with three decimals, or in the unit that fits") {
  CHECK(count_text(1'195'306) == "1,195,306");
  CHECK(count_text(999) == "999");
  CHECK(count_text(1000) == "1,000");
  CHECK(ratio_text(1.00349) == "1.003");
  CHECK(time_text(30.2) == "30.2 ns");
  CHECK(time_text(438'000) == "438 µs");
  CHECK(time_text(38.1e6) == "38.1 ms");
  CHECK(time_text(249.2e9) == "249 s");
  CHECK(time_text(std::numeric_limits<double>::quiet_NaN()) == "not measured");
}

}  // namespace
}  // namespace runstone::bench
