#include "tests/bench/report/ranking.hpp"

#include <algorithm>
#include <cmath>

#include "tests/bench/report/mesher_names.hpp"

namespace runstone::bench {

void rank(std::vector<Ranked>& all) {
  std::sort(all.begin(), all.end(), [](const Ranked& a, const Ranked& b) {
    if (std::isnan(a.value) || std::isnan(b.value) || a.value == b.value) {
      return std::isnan(a.value) == std::isnan(b.value) ? a.mesher < b.mesher : std::isnan(b.value);
    }
    return a.value < b.value;
  });
}

chart::RankChart chart_of(const std::vector<Ranked>& all, const chart::Axis& axis) {
  chart::RankChart out;
  out.x = axis;
  out.title = axis.title;
  for (const Ranked& each : all) {
    out.names.push_back(long_name_of(each.mesher));
    out.roles.push_back(role_of(each.mesher));
    out.values.push_back(each.value);
    out.notes.push_back(each.note);
  }
  return out;
}

}  // namespace runstone::bench
