// The figures of one group of scenarios: memory, vertices, phases, times.
#include <fmt/format.h>

#include <algorithm>

#include "common/generate/scenarios/scenario_model.hpp"
#include "tests/bench/report/chart/bar_chart.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/frame.hpp"
#include "tests/bench/report/chart/range_chart.hpp"
#include "tests/bench/report/chart/stack_chart.hpp"
#include "tests/bench/report/number_text.hpp"
#include "tests/bench/report/rows.hpp"
#include "tests/bench/report/scenario_case.hpp"
#include "tests/bench/report/thesis_figures.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;
using chart::Role;

/// Bytes of a flat array of 32³ voxels: the thesis' has 8 bytes a voxel, ours 2.
constexpr double kThesisGridBytes = 262'144, kGridBytes = 65'536;
constexpr std::array<const char*, 3> kGroupNames = {"general models", "random voxels", "strips"};

std::vector<unsigned> scenarios_of(unsigned group) {
  std::vector<unsigned> out;
  for (unsigned s = 1; s <= kScenarioCount; ++s) {
    if (scenario_group(s) == group) out.push_back(s);
  }
  return out;
}

std::vector<std::string> names_of(const std::vector<unsigned>& scenarios) {
  std::vector<std::string> out;
  for (const unsigned s : scenarios) out.push_back(std::to_string(s));
  return out;
}

std::vector<std::string> marks_of(const std::vector<unsigned>& scenarios) {
  std::vector<std::string> out;
  for (const ThesisDefect& defect : kThesisDefects) {
    if (std::find(scenarios.begin(), scenarios.end(), defect.scenario) != scenarios.end()) {
      out.push_back(fmt::format("Scenario {}: {}", defect.scenario, defect.what));
    }
  }
  return out;
}

/// Returns a table with a line for each category and a column for each series.
DataTable table_of(const char* category, const chart::BarChart& chart) {
  DataTable out;
  out.columns.push_back(category);
  for (const chart::Series& series : chart.series) out.columns.push_back(series.name);
  for (std::size_t i = 0; i < chart.categories.size(); ++i) {
    std::vector<DataTable::Value> row = {chart.categories[i]};
    for (const chart::Series& series : chart.series) row.emplace_back(series.values[i]);
    out.add(std::move(row));
  }
  return out;
}

}  // namespace

ReportFigure ThesisFigures::memory(unsigned group) const {
  const auto scenarios = scenarios_of(group);
  chart::BarChart bytes{
      names_of(scenarios), {}, {"bytes of a chunk of 32³", true}, "memory of a chunk"};
  bytes.series = {{"thesis: RLE, 12 B a run, as logged", Role::thesis,
                   for_each_scenario(scenarios,
                                     [&](unsigned s) {
                                       return thesis_.value(s, "RLE", "model_memory_logged_mean");
                                     })},
                  {"ours: runs, cheapest axis order", Role::ours,
                   for_each_scenario(scenarios, [&](unsigned s) { return fact(s, "run_bytes"); })}};
  chart::BarChart solid{names_of(scenarios), {}, {"solid voxels, %"}, "share of solid voxels"};
  solid.series = {{"solid voxels", Role::other, for_each_scenario(scenarios, [&](unsigned s) {
                     return 100 * fact(s, "opaque") / fact(s, "voxels");
                   })}};
  ReportFigure out;
  out.id = fmt::format("memory-group-{}", group);
  out.title =
      fmt::format("Memory of group {}, {} (figures 8.4 to 8.9)", group, kGroupNames[group - 1]);
  const double ours = mean_of(bytes.series[1].values), theirs = mean_of(bytes.series[0].values);
  out.sentence = fmt::format(
      "A chunk takes {} bytes of runs on average: {} % less than a flat array of ours (2 bytes a "
      "voxel). The thesis' RLE takes {}, {} % less than its own flat array (8 bytes a voxel).",
      format_value(ours), format_value(100 * (1 - ours / kGridBytes)), format_value(theirs),
      format_value(100 * (1 - theirs / kThesisGridBytes)));
  out.steps = {"facts"};
  out.data = table_of("scenario", bytes);
  out.data.columns.push_back("solid voxels, %");
  for (std::size_t i = 0; i < out.data.rows.size(); ++i)
    out.data.rows[i].emplace_back(solid.series[0].values[i]);
  out.picture = chart::frame_of(bytes) + chart::frame_of(solid);
  out.marks = marks_of(scenarios);
  return out;
}

ReportFigure ThesisFigures::vertices(unsigned group) const {
  const auto scenarios = scenarios_of(group);
  chart::BarChart chart{
      names_of(scenarios), {}, {"vertices of a chunk, mean of 27", true}, "vertices of a chunk"};
  for (const RebuiltMesher& mesher : kRebuiltMeshers) {
    chart.series.push_back(
        {mesher.thesis_name, mesher.thesis == std::string_view("Grid") ? Role::thesis : Role::other,
         for_each_scenario(scenarios,
                           [&](unsigned s) { return thesis_vertices(s, mesher.thesis); })});
  }
  chart.series.push_back(
      {"ours: RDM from runs", Role::ours,
       for_each_scenario(scenarios, [&](unsigned s) { return time(s, "rdm", "vertices"); })});
  ReportFigure out;
  out.id = fmt::format("vertices-group-{}", group);
  out.title =
      fmt::format("Vertices of group {}, {} (figures 8.11 to 8.13)", group, kGroupNames[group - 1]);
  out.sentence = fmt::format(
      "Ours needs {} vertices a chunk on average, the thesis' Grid RDM {}, "
      "its RLE RDM {} and Voxel Plugin {}. {}",
      format_value(mean_of(chart.series[3].values)), format_value(mean_of(chart.series[0].values)),
      format_value(mean_of(chart.series[1].values)), format_value(mean_of(chart.series[2].values)),
      agreement(scenarios));
  out.steps = {"thesis"};
  out.data = table_of("scenario", chart);
  for (const RebuiltMesher& mesher : kRebuiltMeshers) {
    out.data.columns.push_back(mesher.rebuilt_name);
    for (std::size_t i = 0; i < scenarios.size(); ++i) {
      out.data.rows[i].emplace_back(time(scenarios[i], mesher.rebuilt, "vertices"));
    }
  }
  out.picture = chart::frame_of(chart);
  out.marks = marks_of(scenarios);
  return out;
}

ReportFigure ThesisFigures::phases(unsigned group) const {
  const auto scenarios = scenarios_of(group);
  const auto mean = [&](auto&& value) { return mean_of(for_each_scenario(scenarios, value)); };
  chart::StackChart theirs{
      {}, {}, {"mean ms of a chunk (Unreal Engine, Xeon E3-1240 v5)"}, "phases, thesis"};
  theirs.parts = {{"octree", Role::other, {}},
                  {"meshing", Role::other, {}},
                  {"engine buffers", Role::other, {}},
                  {"other", Role::other, {}}};
  for (const RebuiltMesher& mesher : kRebuiltMeshers) {
    theirs.names.push_back(mesher.thesis_name);
    const std::array<const char*, 4> metrics = {"octree_mean", "meshing_mean", "buffer_mean",
                                                "other_mean"};
    for (std::size_t p = 0; p < metrics.size(); ++p) {
      theirs.parts[p].values.push_back(
          mean([&](unsigned s) { return thesis_.value(s, mesher.thesis, metrics[p]); }));
    }
  }
  chart::StackChart ours{{}, {}, {"mean µs of a chunk (this machine)"}, "phases, ours"};
  const std::array<const char*, 4> phases = {"decode", "octree", "mask", "mesh"};
  for (const char* phase : phases) ours.parts.push_back({phase, Role::other, {}});
  const auto add = [&](const std::string& name, const char* mesher) {
    ours.names.push_back(name);
    for (std::size_t p = 0; p < phases.size(); ++p) {
      ours.parts[p].values.push_back(mean(
          [&](unsigned s) { return time(s, mesher, fmt::format("{}_ns", phases[p])) / 1000; }));
    }
  };
  add("ours: RDM from runs", "rdm");
  add("decode + binary greedy", "decode_binary");
  for (const RebuiltMesher& mesher : kRebuiltMeshers) add(mesher.rebuilt_name, mesher.rebuilt);
  ReportFigure out;
  out.id = fmt::format("phases-group-{}", group);
  out.title = fmt::format("Where the time goes in group {}, {} (figures 8.16 to 8.19)", group,
                          kGroupNames[group - 1]);
  const auto total = [&](const char* mesher) {
    return mean([&](unsigned s) { return time(s, mesher, "mean_ns") / 1000; });
  };
  out.sentence = fmt::format(
      "Ours meshes a chunk in {} µs, with no phase before it and none after: "
      "quads are what the GPU reads. On the same machine the rebuilt Grid RDM takes {} µs, "
      "RLE RDM {}, and decoding first and meshing with the fastest dense mesher {}. "
      "Compare the thesis' milliseconds by their shares only: another machine, "
      "and an engine around them.",
      format_value(total("rdm")), format_value(total("grid_rdm")), format_value(total("rle_rdm")),
      format_value(total("decode_binary")));
  out.steps = {"thesis"};
  out.data.columns = {"source", "mesher", "phase", "mean"};
  for (const auto* chart : {&theirs, &ours}) {
    for (const chart::Series& part : chart->parts) {
      for (std::size_t i = 0; i < chart->names.size(); ++i) {
        out.data.add({chart == &theirs ? "thesis, ms" : "ours, us", chart->names[i], part.name,
                      part.values[i]});
      }
    }
  }
  out.picture = chart::frame_of(ours) + chart::frame_of(theirs);
  out.marks = marks_of(scenarios);
  out.marks.push_back(kVoxelPluginEvents);
  return out;
}

ReportFigure ThesisFigures::timing(unsigned group) const {
  const auto scenarios = scenarios_of(group);
  chart::RangeChart chart;
  chart.x = {"µs of a chunk, over 27 chunks", true};
  chart.value_names = {"least", "median", "greatest", ""};
  chart.title = "time of a chunk";
  ReportFigure out;
  out.data.columns = {"scenario", "mesher", "least us", "median us", "mean us", "greatest us"};
  double ours_sum = 0, thesis_sum = 0;
  for (const unsigned s : scenarios) {
    const auto thesis_us = [&](const char* metric) {
      return 1000 * thesis_.value(s, "RLE", metric);
    };
    const auto our_us = [&](const char* column) { return time(s, "rdm", column) / 1000; };
    const auto add = [&](const std::string& name, Role role, double low, double middle,
                         double average, double high) {
      chart.names.push_back(fmt::format("{} {}", s, name));
      chart.roles.push_back(role);
      chart.ranges.push_back({low, middle, high, kNoNumber});
      out.data.add({std::to_string(s), name, low, middle, average, high});
    };
    add("ours", Role::ours, our_us("min_ns"), our_us("median_ns"), our_us("mean_ns"),
        our_us("max_ns"));
    add("thesis", Role::thesis, thesis_us("total_min"), thesis_us("total_median"),
        thesis_us("total_mean"), thesis_us("total_max"));
    ours_sum += our_us("mean_ns");
    thesis_sum += thesis_us("total_mean");
  }
  out.id = fmt::format("timing-group-{}", group);
  out.title = fmt::format(
      "Meshing from runs in group {}, {}: least, median, greatest (figures 8.20 and 8.21)", group,
      kGroupNames[group - 1]);
  out.sentence = fmt::format(
      "The thesis' RLE RDM took {} times as long as ours over the group, "
      "on another machine and with Unreal's buffers: look at how both rise and fall with the "
      "model.",
      format_value(thesis_sum / ours_sum));
  out.steps = {"thesis"};
  out.picture = chart::frame_of(chart);
  out.marks = marks_of(scenarios);
  return out;
}

}  // namespace runstone::bench
