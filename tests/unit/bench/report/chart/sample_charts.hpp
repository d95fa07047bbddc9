// One chart of each kind with the caller's values, for tests of all kinds.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/report/chart/bar_chart.hpp"
#include "tests/bench/report/chart/heat_map.hpp"
#include "tests/bench/report/chart/line_chart.hpp"
#include "tests/bench/report/chart/range_chart.hpp"
#include "tests/bench/report/chart/rank_chart.hpp"
#include "tests/bench/report/chart/scatter_chart.hpp"
#include "tests/bench/report/chart/stack_chart.hpp"

namespace runstone::bench::chart {

struct SampleData {
  std::vector<std::string> names = {};
  std::function<double()> value = {};
  bool is_log = false;
};

inline Role sample_role(std::size_t i) {
  constexpr Role kRoles[] = {Role::ours, Role::baseline, Role::thesis, Role::other};
  return kRoles[i < 4 ? i : 3];
}

/// Returns kind and chart.
inline std::vector<std::pair<std::string, std::string>> sample_svgs(const SampleData& data,
                                                                    Width width) {
  const Axis axis{"time per chunk, \xC2\xB5s", data.is_log};
  const std::size_t count = data.names.size();
  std::vector<Role> roles;
  for (std::size_t i = 0; i < count; ++i) roles.push_back(sample_role(i));
  const auto values = [&](std::size_t n) {
    std::vector<double> out;
    for (std::size_t i = 0; i < n; ++i) out.push_back(data.value());
    return out;
  };
  std::vector<Series> series;
  for (std::size_t i = 0; i < 5; ++i)
    series.push_back({"series " + std::to_string(i), sample_role(i), values(count)});
  LineChart lines{axis, axis, {}, "lines", {}, true};
  ScatterChart scatter{axis, axis, {}, true, "scatter"};
  RangeChart ranges{data.names, {}, roles, axis, {"p10", "p50", "p90", "p99"}, "ranges"};
  for (std::size_t i = 0; i < count; ++i) {
    lines.lines.push_back({data.names[i], roles[i], {}});
    for (int k = 0; k < 4; ++k) lines.lines.back().points.push_back({data.value(), data.value()});
    const auto& points = lines.lines.back().points;
    lines.spans.push_back({points[0].x, points[1].x, data.names[i]});
    scatter.points.push_back({data.value(), data.value(), data.names[i], roles[i], i % 5 != 4});
    ranges.ranges.push_back({data.value(), data.value(), data.value(), data.value()});
  }
  return {{"bars", svg_of(BarChart{data.names, series, axis, "bars"}, width)},
          {"rank",
           svg_of(RankChart{data.names, roles, values(count), axis, {"", "\xC3\x97 2.5"}, "rank"},
                  width)},
          {"stack", svg_of(StackChart{data.names, series, axis, "stack"}, width)},
          {"lines", svg_of(lines, width)},
          {"scatter", svg_of(scatter, width)},
          {"ranges", svg_of(ranges, width)},
          {"heat", svg_of(HeatMap{data.names, data.names, values(count * count), axis, format_value,
                                  true, "heat"},
                          width)}};
}

}  // namespace runstone::bench::chart
