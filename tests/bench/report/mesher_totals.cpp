#include "tests/bench/report/mesher_totals.hpp"

#include <algorithm>
#include <cmath>

#include "common/generate/scenarios/scenario_model.hpp"

namespace runstone::bench {
namespace {

bool is_whole(const std::vector<double>& values) {
  return values.size() == kScenarioCount &&
         std::none_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
}

}  // namespace

std::vector<MesherTotal> mesher_totals(const Rows& rows) {
  std::vector<MesherTotal> out;
  for (const std::string& mesher : rows.kinds("mesher")) {
    const Rows of = rows.where("mesher", mesher);
    const auto sum = [&of](const char* column) {
      const auto values = of.numbers(column);
      return is_whole(values) ? sum_of(values) : kNoNumber;
    };
    const auto times = of.numbers("median_ns");
    out.push_back({mesher, is_whole(times) ? geometric_mean_of(times) : kNoNumber, sum("median_ns"),
                   sum("triangles"), sum("t_junctions")});
  }
  return out;
}

MesherTotal total_of(const std::vector<MesherTotal>& totals, std::string_view mesher) {
  const auto found = std::find_if(totals.begin(), totals.end(),
                                  [&](const MesherTotal& total) { return total.mesher == mesher; });
  return found == totals.end()
             ? MesherTotal{std::string(mesher), kNoNumber, kNoNumber, kNoNumber, kNoNumber}
             : *found;
}

}  // namespace runstone::bench
