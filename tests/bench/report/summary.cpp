#include "tests/bench/report/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/mesher_names.hpp"
#include "tests/bench/report/mesher_totals.hpp"
#include "tests/bench/report/number_text.hpp"
#include "tests/bench/report/verdicts.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;

/// The meshers of README.md: the product, the thesis' own, and the three that a reader knows.
constexpr std::array<std::string_view, 5> kSummaryMeshers = {"rdm", "rle_rdm", "decode_binary",
                                                             "simple", "greedy"};

std::string meshers_table(const Rows& rows) {
  auto totals = mesher_totals(rows);
  std::erase_if(totals, [](const MesherTotal& total) {
    const bool is_listed = std::find(kSummaryMeshers.begin(), kSummaryMeshers.end(),
                                     total.mesher) != kSummaryMeshers.end();
    return !is_listed || std::isnan(total.mean_ns);
  });
  std::sort(totals.begin(), totals.end(),
            [](const MesherTotal& a, const MesherTotal& b) { return a.mean_ns < b.mean_ns; });
  std::string out =
      "| mesher, the thesis' 37 scenarios, 32³ | µs a chunk (geometric mean) | triangles (sum) |\n"
      "|---|---|---|\n";
  for (const MesherTotal& total : totals) {
    out += fmt::format("| {} | {} | {} |\n", long_name_of(total.mesher),
                       format_value(total.mean_ns / 1000), count_text(total.triangles));
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
  out += fmt::format("{}, one core; {}; vectors {}; commit {}; real world {}; a {} run.\n", m.cpu,
                     m.compiler, m.simd, m.commit, finding.luanti,
                     finding.is_quick ? "quick" : "full");
  return out;
}

}  // namespace runstone::bench
