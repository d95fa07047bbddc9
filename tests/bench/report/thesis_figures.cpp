#include "tests/bench/report/thesis_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace runstone::bench {

ThesisFigures::ThesisFigures(const Evidence& evidence)
    : thesis_(evidence.thesis),
      facts_(evidence.findings.rows("facts")),
      times_(evidence.findings.rows("thesis")),
      findings_(evidence.findings) {}

double ThesisFigures::fact(unsigned scenario, const std::string& column) const {
  return facts_.where("scenario", scenario).number(column);
}

double ThesisFigures::time(unsigned scenario, std::string_view mesher,
                           const std::string& column) const {
  return times_.where("scenario", scenario).where("mesher", mesher).number(column);
}

double ThesisFigures::thesis_vertices(unsigned scenario, std::string_view mesher) const {
  return thesis_.value(scenario, mesher, "vertices_mean");
}

std::string ThesisFigures::agreement(const std::vector<unsigned>& scenarios) const {
  std::string out = "Our rebuilt meshers give the thesis' mean:";
  for (std::size_t i = 0; i < 2; ++i) {
    const RebuiltMesher& mesher = kRebuiltMeshers[i];
    const auto agrees = [&](unsigned s) {
      return std::abs(time(s, mesher.rebuilt, "vertices") - thesis_vertices(s, mesher.thesis)) <
             0.01;
    };
    out += fmt::format("{} {} in {} of {}", i == 0 ? "" : ",", mesher.thesis,
                       std::count_if(scenarios.begin(), scenarios.end(), agrees), scenarios.size());
  }
  return out + ".";
}

}  // namespace runstone::bench
