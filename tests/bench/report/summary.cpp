#include "tests/bench/report/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/mesher_names.hpp"
#include "tests/bench/report/mesher_totals.hpp"
#include "tests/bench/report/number_text.hpp"
#include "tests/bench/report/verdicts.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;

std::string meshers_table(const Rows& rows) {
  auto totals = mesher_totals(rows);
  std::erase_if(totals, [](const MesherTotal& total) { return std::isnan(total.mean_ns); });
  std::sort(totals.begin(), totals.end(),
            [](const MesherTotal& a, const MesherTotal& b) { return a.mean_ns < b.mean_ns; });
  const double optimum = total_of(totals, "optimal_greedy").triangles;
  std::string out =
      "| mesher, the thesis' 37 scenarios, 32³ | µs a chunk (geometric mean) | triangles (sum) | "
      "of the optimum | T-junctions (sum) |\n|---|---|---|---|---|\n";
  for (const MesherTotal& total : totals) {
    out += fmt::format("| {} | {} | {} | {} | {} |\n", long_name_of(total.mesher),
                       format_value(total.mean_ns / 1000), count_text(total.triangles),
                       ratio_text(total.triangles / optimum), count_text(total.t_junctions));
  }
  return out;
}

}  // namespace

std::string summary_of(const Evidence& evidence) {
  const Rows meshers = evidence.findings.rows("meshers");
  if (meshers.empty()) return "";
  const Verdicts verdicts = verdicts_of(evidence);
  const Finding& finding = *evidence.findings.find("meshers");
  const Machine& m = finding.machine;
  std::string out = verdicts.answer + "\n\n" + meshers_table(meshers) + "\n";
  for (const std::string& doubt : evidence.findings.doubts(verdicts.steps))
    out += "Doubt: " + doubt + "\n\n";
  out += fmt::format("{}, one core; {}; vectors {}; commit {}; real world {}; a {} run.\n\n", m.cpu,
                     m.compiler, m.simd, m.commit, finding.luanti,
                     finding.is_quick ? "quick" : "full");
  out += "| question | wins | loses |\n|---|---|---|\n";
  for (const ReportVerdict& row : verdicts.rows) {
    out += fmt::format("| {} | {} | {} |\n", row.question, row.winner, row.loser);
  }
  return out;
}

}  // namespace runstone::bench
