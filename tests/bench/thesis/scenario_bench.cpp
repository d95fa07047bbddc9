#include "tests/bench/report/scenario_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/core/assert.hpp"
#include "common/generate/scenarios/scenario_model.hpp"
#include "common/runs/reorder.hpp"
#include "tests/bench/harness/statistics.hpp"
#include "tests/bench/meshing/cell.hpp"
#include "tests/bench/meshing/order_name.hpp"
#include "tests/support/scenario_scene.hpp"

namespace runstone::bench {
namespace {

using nlohmann::json;

constexpr unsigned kEdge = 32;  // the thesis' edge
constexpr std::array<std::string_view, 5> kMeshers = {"rdm", "decode_binary", "grid_rdm", "rle_rdm",
                                                      "culled"};

template <class F>
void for_each_chunk(F&& chunk) {
  for (std::int32_t x = -1; x <= 1; ++x) {
    for (std::int32_t y = -1; y <= 1; ++y) {
      for (std::int32_t z = -1; z <= 1; ++z) chunk(ChunkCoord{x, y, z});
    }
  }
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// The times of one mesher on each chunk of a scenario.
struct Times {
  std::vector<double> ns, vertices;
  std::array<std::vector<double>, kPhaseCount> phases;
};

json row_of(unsigned scenario, std::string_view mesher, const Times& times) {
  json row = {{"scenario", scenario},
              {"group", scenario_group(scenario)},
              {"mesher", mesher},
              {"chunks", times.ns.size()},
              {"mean_ns", mean(times.ns)},
              {"median_ns", median(times.ns)},
              {"min_ns", *std::min_element(times.ns.begin(), times.ns.end())},
              {"max_ns", *std::max_element(times.ns.begin(), times.ns.end())},
              {"vertices", mean(times.vertices)}};
  for (std::size_t p = 0; p < kPhaseCount; ++p) {
    row[std::string(kPhaseNames[p]) + "_ns"] = mean(times.phases[p]);
  }
  return row;
}

}  // namespace

unsigned scenario_group(unsigned number) { return number <= 17 ? 1 : number <= 22 ? 2 : 3; }

json scenario_facts(std::ostream& progress) {
  json rows = json::array();
  for (unsigned number = 1; number <= kScenarioCount; ++number) {
    const auto world = test::scenario_generator(number, kEdge);
    std::array<double, kAxisOrderCount> runs{};
    double opaque = 0, fewest = 0, bytes = 0, logged = 0, chunks = 0;
    for_each_chunk([&](ChunkCoord at) {
      const auto scene = test::scenario_scene(*world, at, kEdge, false);
      const auto per_order = runs_per_order(scene.chunk);
      for (std::size_t i = 0; i < per_order.size(); ++i) runs[i] += per_order[i];
      opaque += test::numbers_of(scene).opaque_voxels;
      fewest += static_cast<double>(scene.chunk.runs.size());
      bytes += static_cast<double>(scene.chunk.runs.byte_size());
      logged += test::rle_bytes_logged(scene);
      ++chunks;
    });
    json row = {{"scenario", number},
                {"group", scenario_group(number)},
                {"voxels", kEdge * kEdge * kEdge},
                {"opaque", opaque / chunks},
                {"runs_fewest", fewest / chunks},
                {"run_bytes", bytes / chunks},
                {"thesis_bytes", logged / chunks}};
    for (const AxisOrder order : kAxisOrders) {
      row["runs_" + name_of(order)] = runs[static_cast<std::size_t>(order)] / chunks;
    }
    rows.push_back(std::move(row));
  }
  fmt::print(progress, "{} scenarios\n", rows.size());
  return {{"rows", rows}};
}

json scenario_times(unsigned repetitions, std::ostream& progress) {
  json rows = json::array();
  for (unsigned number = 1; number <= kScenarioCount; ++number) {
    const auto world = test::scenario_generator(number, kEdge);
    std::array<Times, kMeshers.size()> times;
    for_each_chunk([&](ChunkCoord at) {
      const Volume volume{{}, kEdge, test::scenario_scene(*world, at, kEdge, false)};
      std::vector<MesherCase> mesher_cases;
      for (const std::string_view mesher : kMeshers) {
        auto mesher_case = make_mesher_case(mesher, volume, test::scenario_visibility());
        RUNSTONE_ASSERT(mesher_case.has_value());
        mesher_cases.push_back(*std::move(mesher_case));
      }
      const auto measured = measure_cell(mesher_cases, repetitions);
      for (std::size_t i = 0; i < measured.size(); ++i) {
        if (!measured[i]) continue;
        times[i].ns.push_back(measured[i]->median_ns);
        times[i].vertices.push_back(4 * static_cast<double>(measured[i]->quads));
        for (std::size_t p = 0; p < kPhaseCount; ++p)
          times[i].phases[p].push_back(measured[i]->phase_ns[p]);
      }
    });
    for (std::size_t i = 0; i < kMeshers.size(); ++i) {
      if (!times[i].ns.empty()) rows.push_back(row_of(number, kMeshers[i], times[i]));
    }
    fmt::print(progress, "scenario {}\n", number);
    progress.flush();
  }
  return {{"repetitions", repetitions}, {"rows", rows}};
}

}  // namespace runstone::bench
