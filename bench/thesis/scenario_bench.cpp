#include "bench/thesis/scenario_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "bench/harness/machine_json.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/meshing/cell.hpp"
#include "bench/meshing/order_name.hpp"
#include "common/core/assert.hpp"
#include "common/generate/scenarios/scenario_model.hpp"
#include "common/runs/reorder.hpp"
#include "tests/support/scenarios/scenario_scene.hpp"

namespace runstone::bench {
namespace {

using nlohmann::ordered_json;

constexpr unsigned kEdge = 32;  // the thesis' edge
constexpr std::array<std::string_view, 6> kMeshers = {"rdm",      "decode_binary", "mask_binary",
                                                      "grid_rdm", "rle_rdm",       "culled"};
constexpr std::size_t kProduct = 0;  // index in kMeshers

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

unsigned group_of(unsigned scenario) { return scenario <= 17 ? 1 : scenario <= 22 ? 2 : 3; }

/// The figures of one mesher over the chunks of a scenario.
struct Times {
  std::vector<double> vertices;  // of all chunks
  std::vector<double> ns;        // of the chunks that have quads, like the phases
  std::array<std::vector<double>, kPhaseCount> phases;

  void add(const Timing& timing, bool has_quads) {
    vertices.push_back(4 * static_cast<double>(timing.quads));
    if (!has_quads) return;
    ns.push_back(timing.median_ns);
    for (std::size_t p = 0; p < kPhaseCount; ++p) phases[p].push_back(timing.phase_ns[p]);
  }
};

ordered_json row_of(unsigned scenario, std::string_view mesher, const Times& times) {
  ordered_json row = {{"scenario", scenario},
                      {"group", group_of(scenario)},
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

ScenarioTable scenario_facts(std::ostream& progress) {
  ScenarioTable out;
  out.machine = this_machine();
  for (unsigned number = 1; number <= kScenarioCount; ++number) {
    const auto world = test::scenario_generator(number, kEdge);
    std::array<double, kAxisOrderCount> runs{};
    double opaque = 0, fewest = 0, bytes = 0, logged = 0, chunks = 0;
    unsigned without_quads = 0;
    for_each_chunk([&](ChunkCoord at) {
      const auto scene = test::scenario_scene(*world, at, kEdge, false);
      const auto per_order = runs_per_order(scene.chunk);
      for (std::size_t i = 0; i < per_order.size(); ++i) runs[i] += per_order[i];
      const test::ScenarioNumbers numbers = test::numbers_of(scene);
      opaque += numbers.opaque_voxels;
      without_quads += numbers.vertices_culled == 0 ? 1U : 0U;
      fewest += static_cast<double>(scene.chunk.runs.size());
      bytes += static_cast<double>(scene.chunk.runs.byte_size());
      logged += test::rle_bytes_logged(scene);
      ++chunks;
    });
    ordered_json row = {{"scenario", number},
                        {"group", group_of(number)},
                        {"voxels", kEdge * kEdge * kEdge},
                        {"chunks_without_quads", without_quads},
                        {"opaque", opaque / chunks},
                        {"runs_fewest", fewest / chunks},
                        {"run_bytes", bytes / chunks},
                        {"thesis_bytes", logged / chunks}};
    for (const AxisOrder order : kAxisOrders) {
      row["runs_" + name_of(order)] = runs[static_cast<std::size_t>(order)] / chunks;
    }
    out.rows.push_back(std::move(row));
  }
  fmt::print(progress, "{} scenarios\n", out.rows.size());
  return out;
}

ScenarioTable scenario_times(unsigned repetitions, std::ostream& progress) {
  ScenarioTable out;
  out.machine = this_machine();
  out.repetitions = repetitions;
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
      const bool has_quads = measured[kProduct] && measured[kProduct]->quads > 0;
      for (std::size_t i = 0; i < measured.size(); ++i) {
        if (measured[i]) times[i].add(*measured[i], has_quads);
      }
    });
    for (std::size_t i = 0; i < kMeshers.size(); ++i) {
      if (!times[i].ns.empty()) out.rows.push_back(row_of(number, kMeshers[i], times[i]));
    }
    fmt::print(progress, "scenario {}\n", number);
    progress.flush();
  }
  return out;
}

void write_table(const ScenarioTable& table, std::ostream& out) {
  if (table.rows.empty()) return;
  const auto line = [&out](const ordered_json& row, auto&& cell) {
    for (const auto& [key, value] : row.items()) fmt::print(out, "| {} ", cell(key, value));
    fmt::print(out, "|\n");
  };
  line(table.rows.front(), [](const std::string& key, const ordered_json&) { return key; });
  line(table.rows.front(), [](const std::string&, const ordered_json&) { return "---"; });
  for (const ordered_json& row : table.rows) {
    line(row, [](const std::string&, const ordered_json& value) {
      if (value.is_string()) return value.get<std::string>();
      return fmt::format("{:.6g}", value.get<double>());
    });
  }
}

void write_json(const ScenarioTable& table, std::ostream& out) {
  const ordered_json document = {{"machine", json_of(table.machine)},
                                 {"repetitions", table.repetitions},
                                 {"rows", table.rows}};
  out << document.dump(1) << '\n';
}

}  // namespace runstone::bench
