#include "tests/bench/report/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/generate/scenarios/scenario_model.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/mesher_names.hpp"
#include "tests/bench/report/verdicts.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;

struct Line {
  std::string name;
  double us = 0;
  std::string text;
};

std::string meshers_table(const Rows& rows) {
  const double optimum = sum_of(rows.where("mesher", "optimal_greedy").numbers("triangles"));
  std::vector<Line> lines;
  for (const std::string& mesher : rows.kinds("mesher")) {
    const Rows of = rows.where("mesher", mesher);
    if (of.size() != kScenarioCount) continue;  // too slow somewhere: its mean would be of other scenarios
    const double us = geometric_mean_of(of.numbers("median_ns")) / 1000,
                 triangles = sum_of(of.numbers("triangles"));
    lines.push_back({mesher, us,
                     fmt::format("| {} | {} | {} | {} | {} |\n", long_name_of(mesher), format_value(us),
                                 format_value(triangles), format_value(triangles / optimum),
                                 format_value(sum_of(of.numbers("t_junctions"))))});
  }
  std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.us < b.us; });
  std::string out =
      "| mesher, the thesis' 37 scenarios, 32³ | µs a chunk (geometric mean) | triangles (sum) | of the "
      "optimum | T-junctions (sum) "
      "|\n|---|---|---|---|---|\n";
  for (const Line& line : lines) out += line.text;
  return out;
}

}  // namespace

std::string summary_of(const Evidence& evidence) {
  const Rows meshers = evidence.findings.rows("meshers");
  if (meshers.empty()) return "";
  const Verdicts verdicts = verdicts_of(evidence);
  const Machine& m = evidence.findings.find("meshers")->machine;
  std::string out = verdicts.answer + "\n\n" + meshers_table(meshers) + "\n";
  out +=
      fmt::format("{}, one core; {}; vectors {}; commit {}.\n\n| question | wins | loses |\n|---|---|---|\n",
                  m.cpu, m.compiler, m.simd, m.commit);
  for (const ReportVerdict& row : verdicts.rows) {
    out += fmt::format("| {} | {} | {} |\n", row.question, row.winner, row.loser);
  }
  return out;
}

}  // namespace runstone::bench
