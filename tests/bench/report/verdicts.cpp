#include "tests/bench/report/verdicts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "common/generate/scenarios/scenario_model.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/mesher_names.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;

constexpr double kDenseBytes = 32 * 32 * 32 * 2;

struct Candidate {
  std::string name;
  double value = 0;
};

/// The least wins, the greatest loses. No row where fewer than two were measured.
void judge(Verdicts& out, const char* question, const char* figure, std::vector<Candidate> candidates,
           const std::string& unit) {
  std::erase_if(candidates, [](const Candidate& each) { return !std::isfinite(each.value); });
  if (candidates.size() < 2) return;
  const auto [least, most] =
      std::minmax_element(candidates.begin(), candidates.end(),
                          [](const Candidate& a, const Candidate& b) { return a.value < b.value; });
  const auto text = [&](const Candidate& each) {
    return fmt::format("{}: {}{}", each.name, format_value(each.value), unit);
  };
  out.rows.push_back({question, text(*least), text(*most), figure});
}

/// Of each mesher measured in all scenarios: the geometric mean of one column, times `unit`; or, without one, its sum.
std::vector<Candidate> of_meshers(const Rows& rows, const std::vector<const char*>& meshers,
                                  const char* column, double unit = 0) {
  std::vector<Candidate> out;
  for (const char* mesher : meshers) {
    const Rows of = rows.where("mesher", mesher);
    if (of.size() != kScenarioCount) continue;
    const auto values = of.numbers(column);
    const bool is_whole = std::none_of(values.begin(), values.end(), [](double v) { return std::isnan(v); });
    if (is_whole)
      out.push_back({long_name_of(mesher), unit == 0 ? sum_of(values) : unit * geometric_mean_of(values)});
  }
  return out;
}

double geometric_ratio(const Rows& rows, const char* mesher, const char* against) {
  std::vector<double> ratios;
  for (const std::string& part : rows.kinds("part")) {
    const Rows at = rows.where("part", part);
    ratios.push_back(at.where("mesher", against).number("median_ns") /
                     at.where("mesher", mesher).number("median_ns"));
  }
  return geometric_mean_of(ratios);
}

std::string answer_of(const Evidence& evidence) {
  const Rows meshers = evidence.findings.rows("meshers"), landscapes = evidence.findings.rows("landscapes");
  if (meshers.empty()) return "The meshers were not measured yet.";
  const double gain = geometric_ratio(meshers, "rdm", "decode_binary");
  std::size_t wins = 0, all = 0;
  std::string losses;
  for (const std::string& part : meshers.kinds("part")) {
    const Rows at = meshers.where("part", part);
    const bool is_won = at.where("mesher", "rdm").number("median_ns") <
                        at.where("mesher", "decode_binary").number("median_ns");
    wins += is_won ? 1U : 0U;
    ++all;
    if (!is_won) losses += (losses.empty() ? "" : ", ") + part;
  }
  const char* const loses = losses.empty() ? "" : "; it loses in scenario ";
  std::string out = gain >= 1 ? fmt::format(
                                    "Counted from what is stored, the fastest mesher is Run Directional "
                                    "Meshing straight from compressed runs: over "
                                    "the thesis' 37 scenarios, decoding and meshing with the fastest dense "
                                    "mesher, binary greedy, takes {} times as "
                                    "long (geometric mean), and RDM is faster in {} of {}{}{}. ",
                                    format_value(gain), wins, all, loses, losses)
                              : fmt::format(
                                    "Counted from what is stored, decoding and meshing with the fastest "
                                    "dense mesher, binary greedy, is the fastest "
                                    "here: meshing straight from runs takes {} times as long (geometric "
                                    "mean), and is faster in {} of {}. ",
                                    format_value(1 / gain), wins, all);
  const double real = geometric_ratio(landscapes.where("world", "luanti"), "rdm", "decode_binary");
  if (!std::isnan(real)) {
    out +=
        fmt::format("In a real world, made by another program, decoding and meshing takes {} times as long. ",
                    format_value(real));
  }
  const double kept = mean_of(evidence.findings.rows("facts").numbers("run_bytes")) / kDenseBytes;
  if (gain >= 1 && !std::isnan(kept)) {
    out += fmt::format(
        "So meshing from compressed data pays: a chunk of the scenarios takes {} % less memory than a dense "
        "array of two bytes a "
        "voxel, nothing is unpacked, and it costs less time, not more, except where nearly every voxel "
        "differs from the next.",
        format_value(100 * (1 - kept)));
  }
  return out;
}

}  // namespace

Verdicts verdicts_of(const Evidence& evidence) {
  const Findings& findings = evidence.findings;
  const Rows meshers = findings.rows("meshers");
  Verdicts out;
  out.answer = answer_of(evidence);
  judge(out, "Fastest mesher from what is stored (37 scenarios)", "meshers-time",
        of_meshers(meshers, {"rdm", "decode_binary", "rle_rdm", "culled"}, "median_ns", 1e-3), " µs");
  judge(out, "Fewest triangles without searching for the optimum", "meshers-triangles",
        of_meshers(meshers,
                   {"rdm", "decode_binary", "grid_rdm", "rle_rdm", "culled", "simple", "greedy",
                    "naive_greedy", "run_strips"},
                   "triangles"),
        "");
  judge(out, "Fewest T-junctions among meshers that merge", "t-junctions",
        of_meshers(meshers,
                   {"rdm", "decode_binary", "grid_rdm", "greedy", "naive_greedy", "run_strips",
                    "optimal_greedy", "monotone", "poly2tri"},
                   "t_junctions"),
        "");
  std::vector<Candidate> forms;
  const Rows bytes = findings.rows("bytes").where("world", "luanti").where("set", "all");
  for (const auto& [form, name] :
       std::array<std::pair<const char*, const char*>, 6>{{{"packed", "packed runs"},
                                                           {"coded", "coded runs"},
                                                           {"raw", "raw runs"},
                                                           {"dense_zstd", "dense + zstd"},
                                                           {"luanti", "Luanti's form"},
                                                           {"minecraft", "Minecraft's form"}}}) {
    forms.push_back({name, bytes.where("form", form).number("bytes")});
  }
  judge(out, "Fewest bytes of a chunk of a real world on the wire", "bytes", std::move(forms), " B");
  for (const char* profile : {"loopback", "broadband"}) {
    const Rows at =
        findings.rows(fmt::format("transfer-{}", profile), "figures").where("figure", "complete_ms");
    std::vector<Candidate> ways;
    for (const auto& [form, name] :
         std::array<std::pair<const char*, const char*>, 4>{{{"packed", "packed + RDM"},
                                                             {"raw", "raw runs + RDM"},
                                                             {"dense_zstd", "dense, zstd + binary"},
                                                             {"dense", "dense + binary"}}}) {
      ways.push_back({name, at.where("case", fmt::format("luanti {}", form)).number("value")});
    }
    judge(out,
          profile == std::string_view("loopback") ? "A real world sent and meshed, on loopback"
                                                  : "The same over broadband",
          "transfers", std::move(ways), " ms");
  }
  return out;
}

}  // namespace runstone::bench
