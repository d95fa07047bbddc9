// The thesis' figures over all scenarios: the time by the edge of a chunk, and time against
// vertices.
#include <fmt/format.h>

#include "common/generate/scenarios/scenario_model.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/frame.hpp"
#include "tests/bench/report/chart/line_chart.hpp"
#include "tests/bench/report/chart/scatter_chart.hpp"
#include "tests/bench/report/number_text.hpp"
#include "tests/bench/report/scenario_case.hpp"
#include "tests/bench/report/thesis_figures.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;
using chart::Role;

constexpr double kNsPerMs = 1e6;

/// Returns the column of the thesis' results with the total time of a mesher. Voxel Plugin logs 484
/// events a scenario, of which about 27 are chunks with voxels.
const char* total_of(const RebuiltMesher& mesher) {
  return mesher.thesis == std::string_view("VoxelPlugin") ? "total_mean_nonempty_chunks"
                                                          : "total_mean";
}

std::vector<unsigned> all_scenarios() {
  std::vector<unsigned> out;
  for (unsigned s = 1; s <= kScenarioCount; ++s) out.push_back(s);
  return out;
}

}  // namespace

ReportFigure ThesisFigures::chunk_sizes(unsigned scenario) const {
  const bool is_noise = scenario == 5;
  const Rows rows = is_noise
                        ? findings_.rows("chunk-sizes-terrain")
                        : findings_.rows("chunk-sizes").where("part", std::to_string(scenario));
  chart::LineChart chart;
  chart.x = {"side of the chunk, voxels", true};
  chart.y = {"ms of a chunk", true};
  chart.title = "time by side of the chunk";
  ReportFigure out;
  out.data.columns = {"mesher", "side", "ms"};
  const std::array<unsigned, 5> sides = {8, 16, 32, 64, 128};
  const auto add = [&](const std::string& name, Role role, auto&& value) {
    chart::LineSeries line{name, role, {}};
    for (const unsigned side : sides) {
      line.points.push_back({static_cast<double>(side), value(side)});
      out.data.add({name, static_cast<double>(side), line.points.back().y});
    }
    chart.lines.push_back(std::move(line));
  };
  const auto ours = [&](const char* mesher) {
    return [&rows, mesher](unsigned side) {
      return rows.where("mesher", mesher).where("edge", side).number("median_ns") / kNsPerMs;
    };
  };
  add("ours: RDM", Role::ours, ours("rdm"));
  add("decode + binary", Role::baseline, ours("decode_binary"));
  add("rebuilt Grid RDM", Role::other, ours("grid_rdm"));
  add("rebuilt RLE RDM", Role::other, ours("rle_rdm"));
  for (const RebuiltMesher& mesher : kRebuiltMeshers) {
    add(mesher.thesis_name, Role::thesis,
        [&](unsigned side) { return thesis_.chunk_size_ms(scenario, side, mesher.thesis); });
  }
  const auto at = [&](unsigned side) {
    return rows.where("mesher", "rdm").where("edge", side).number("median_ns");
  };
  out.id = fmt::format("chunk-size-{}", scenario);
  out.title = fmt::format("Side of the chunk, scenario {} (figures 8.23 to 8.25)", scenario);
  out.sentence = fmt::format(
      "A chunk of 128³ takes ours {}; the thesis called that side unsuitable for real time ({} "
      "with Grid RDM, {} with RLE RDM). From 32 to 128 the voxels grow 64 times, "
      "our time {} times.",
      time_text(at(128)), time_text(kNsPerMs * thesis_.chunk_size_ms(scenario, 128, "Grid")),
      time_text(kNsPerMs * thesis_.chunk_size_ms(scenario, 128, "RLE")),
      format_value(at(128) / at(32)));
  out.marks.push_back(is_noise ? "Ours: one chunk of our noise terrain."
                               : "Ours: the chunk in the middle; the thesis: the mean of 27.");
  if (is_noise) {
    out.marks.push_back(
        "Scenario 5 is data of side 32 whose generator is not public; "
        "ours is measured on our own noise terrain instead.");
  }
  if (scenario == 1)
    out.marks.push_back(
        "Ours draws nothing of the chunk in the middle of 27 full ones and knows that from one "
        "run.");
  out.marks.push_back(
      "Voxel Plugin always uses chunks of 32³ to draw: its line is no test of the side.");
  if (scenario == 17)
    out.marks.push_back("At 128 the thesis has 5 (Grid) and 12 (RLE) of 27 chunks.");
  out.steps = {is_noise ? "chunk-sizes-terrain" : "chunk-sizes"};
  out.picture = chart::frame_of(chart);
  return out;
}

ReportFigure ThesisFigures::efficiency() const {
  chart::ScatterChart chart;
  chart.x = {"mean ms of a chunk", true};
  chart.y = {"mean vertices of a chunk", true};
  chart.is_low_better = true;
  chart.title = "time against vertices";
  ReportFigure out;
  out.data.columns = {"mesher", "mean ms", "mean vertices"};
  const auto add = [&](const std::string& name, Role role, double ms, double vertices) {
    chart.points.push_back({ms, vertices, name, role, true});
    out.data.add({name, ms, vertices});
  };
  const auto all = all_scenarios();
  for (const RebuiltMesher& mesher : kRebuiltMeshers) {
    add(mesher.thesis_name, Role::thesis,
        mean_of(for_each_scenario(
            all, [&](unsigned s) { return thesis_.value(s, mesher.thesis, total_of(mesher)); })),
        mean_of(
            for_each_scenario(all, [&](unsigned s) { return thesis_vertices(s, mesher.thesis); })));
  }
  const auto add_ours = [&](const std::string& name, Role role, const char* mesher) {
    add(name, role,
        mean_of(for_each_scenario(
            all, [&](unsigned s) { return time(s, mesher, "mean_ns") / kNsPerMs; })),
        mean_of(for_each_scenario(all, [&](unsigned s) { return time(s, mesher, "vertices"); })));
  };
  for (const RebuiltMesher& mesher : kRebuiltMeshers)
    add_ours(mesher.rebuilt_name, Role::other, mesher.rebuilt);
  add_ours("decode + binary greedy", Role::baseline, "decode_binary");
  add_ours("ours: RDM from runs", Role::ours, "rdm");
  out.id = "efficiency";
  out.title = "Efficiency: time against vertices (figure 8.26)";
  const auto& us = chart.points.back();
  const auto& dense = chart.points[chart.points.size() - 2];
  const auto& rle = chart.points[4];
  out.sentence = fmt::format(
      "The good corner is the lower left. Meshing from runs takes {} µs and {} vertices over all "
      "37 scenarios; the same machine needs {} µs to decode and mesh with the fastest dense mesher "
      "({} vertices), and {} µs for the rebuilt RLE RDM of the thesis ({} vertices).",
      format_value(us.x * 1000), format_value(us.y), format_value(dense.x * 1000),
      format_value(dense.y), format_value(rle.x * 1000), format_value(rle.y));
  out.steps = {"thesis"};
  out.picture = chart::frame_of(chart);
  out.marks = {kThesisMeans, kVoxelPluginChunks,
               "The thesis' points were measured on a Xeon E3-1240 v5 inside Unreal Engine 5.4."};
  return out;
}

}  // namespace runstone::bench
