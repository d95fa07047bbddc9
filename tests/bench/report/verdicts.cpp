#include "tests/bench/report/verdicts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/mesher_names.hpp"
#include "tests/bench/report/mesher_totals.hpp"
#include "tests/bench/report/number_text.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;

constexpr double kDenseBytes = 32 * 32 * 32 * 2;

struct Candidate {
  std::string name;
  double value = 0;
};

/// Adds a row: the least wins, the greatest loses, and equals share. Adds none if fewer than two
/// candidates were measured.
void judge(Verdicts& out, const char* question, const char* figure,
           std::vector<Candidate> candidates, const std::function<std::string(double)>& text) {
  std::erase_if(candidates, [](const Candidate& each) { return !std::isfinite(each.value); });
  if (candidates.size() < 2) return;
  const auto [least, most] =
      std::minmax_element(candidates.begin(), candidates.end(),
                          [](const Candidate& a, const Candidate& b) { return a.value < b.value; });
  const auto all_with = [&](double value) {
    std::string names;
    for (const Candidate& each : candidates) {
      if (each.value == value) names += (names.empty() ? "" : ", ") + each.name;
    }
    return names + ": " + text(value);
  };
  out.rows.push_back({question, all_with(least->value), all_with(most->value), figure});
}

std::vector<Candidate> of_meshers(const std::vector<MesherTotal>& totals,
                                  const std::vector<const char*>& meshers,
                                  double MesherTotal::* figure) {
  std::vector<Candidate> out;
  for (const char* mesher : meshers)
    out.push_back({long_name_of(mesher), total_of(totals, mesher).*figure});
  return out;
}

/// The product compared with decoding and dense meshing, part by part.
struct Duel {
  double gain = 0;  // geometric mean of dense / product; NaN if nothing was measured
  std::size_t wins = 0, parts = 0;
  std::string lost;  // names of the parts in which the product is slower
};

Duel duel_of(const Rows& rows) {
  Duel out;
  std::vector<double> ratios;
  for (const std::string& part : rows.kinds("part")) {
    const Rows at = rows.where("part", part);
    const double ratio = at.where("mesher", "decode_binary").number("median_ns") /
                         at.where("mesher", "rdm").number("median_ns");
    if (!std::isfinite(ratio)) continue;
    ratios.push_back(ratio);
    ++out.parts;
    if (ratio > 1) {
      ++out.wins;
    } else {
      out.lost += (out.lost.empty() ? "" : ", ") + part;
    }
  }
  out.gain = geometric_mean_of(ratios);
  return out;
}

std::string answer_of(const Evidence& evidence) {
  const Rows rows = evidence.findings.rows("meshers");
  const auto totals = mesher_totals(rows);
  const Duel scenarios = duel_of(rows);
  const Duel real = duel_of(evidence.findings.rows("landscapes").where("world", "luanti"));
  if (std::isnan(scenarios.gain)) return "The meshers were not measured yet.";
  const bool pays = scenarios.gain > 1;
  const std::string sums =
      format_value(total_of(totals, "decode_binary").sum_ns / total_of(totals, "rdm").sum_ns);
  std::string out = fmt::format(
      "The fastest mesher that starts from the stored runs is {}. "
      "Over the thesis' 37 scenarios (the chunk in the middle), "
      "decoding and meshing with the fastest dense mesher, binary greedy, "
      "takes {} times as long as meshing from runs by the geometric mean and {} times by the sum. "
      "Runs are faster in {} of the {} scenarios{}{}. ",
      pays ? "Run Directional Meshing" : "binary greedy", format_value(scenarios.gain), sums,
      scenarios.wins, scenarios.parts, scenarios.lost.empty() ? "" : "; the exceptions are ",
      scenarios.lost);
  if (!std::isnan(real.gain)) {
    out += fmt::format(
        "In a real world, made by another program, decoding and meshing takes {} times as long, "
        "and runs are faster in {} of {} volumes. ",
        format_value(real.gain), real.wins, real.parts);
  }
  const double kept = mean_of(evidence.findings.rows("facts").numbers("run_bytes")) / kDenseBytes;
  if (!std::isnan(kept)) {
    out += fmt::format(
        "A chunk of the scenarios takes {} % less memory as runs than as an array of two bytes a "
        "voxel.",
        format_value(100 * (1 - kept)));
  }
  return out;
}

}  // namespace

Verdicts verdicts_of(const Evidence& evidence) {
  const Findings& findings = evidence.findings;
  const auto totals = mesher_totals(findings.rows("meshers"));
  const auto unit = [](const char* name) {
    return [name](double value) { return fmt::format("{} {}", format_value(value), name); };
  };
  Verdicts out;
  out.steps = {"meshers", "landscapes",        "facts",
               "bytes",   "transfer-loopback", "transfer-broadband"};
  out.answer = answer_of(evidence);
  judge(out, "Fastest mesher from what is stored (37 scenarios)", "meshers-time",
        of_meshers(totals, {"rdm", "decode_binary", "rle_rdm", "culled"}, &MesherTotal::mean_ns),
        time_text);
  judge(out, "Fewest triangles without searching for the optimum", "meshers-triangles",
        of_meshers(totals,
                   {"rdm", "decode_binary", "grid_rdm", "rle_rdm", "culled", "simple", "greedy",
                    "naive_greedy", "run_strips"},
                   &MesherTotal::triangles),
        count_text);
  judge(out, "Fewest T-junctions among meshers that merge", "t-junctions",
        of_meshers(totals,
                   {"rdm", "decode_binary", "grid_rdm", "rle_rdm", "greedy", "naive_greedy",
                    "run_strips", "run_strips_hidden", "optimal_greedy", "monotone", "poly2tri"},
                   &MesherTotal::t_junctions),
        count_text);
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
  judge(out, "Fewest bytes of a chunk of a real world on the wire", "bytes", std::move(forms),
        unit("B"));
  for (const char* profile : {"loopback", "broadband"}) {
    const Rows at = findings.rows(fmt::format("transfer-{}", profile), "figures")
                        .where("figure", "complete_ms");
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
          "transfers", std::move(ways), unit("ms"));
  }
  return out;
}

}  // namespace runstone::bench
