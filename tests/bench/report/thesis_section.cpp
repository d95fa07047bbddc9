#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/generate/scenarios/scenario_model.hpp"
#include "tests/bench/report/chart/bar_chart.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/frame.hpp"
#include "tests/bench/report/chart/line_chart.hpp"
#include "tests/bench/report/chart/range_chart.hpp"
#include "tests/bench/report/chart/scatter_chart.hpp"
#include "tests/bench/report/chart/stack_chart.hpp"
#include "tests/bench/report/number_text.hpp"
#include "tests/bench/report/report_figure.hpp"
#include "tests/bench/report/scenario_case.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;
using chart::Role;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kGridBytes = 262'144, kOurGridBytes = 65'536, kNsPerMs = 1e6;
constexpr std::array<const char*, 3> kGroupNames = {"general models", "random voxels", "strips"};

/// A mesher of the thesis and our rebuilt one.
struct Rebuilt {
  const char* thesis;
  const char* thesis_name;
  const char* ours;
  const char* our_name;
};
constexpr std::array<Rebuilt, 3> kRebuilt = {
    {{"Grid", "thesis: Grid RDM", "grid_rdm", "rebuilt Grid RDM"},
     {"RLE", "thesis: RLE RDM", "rle_rdm", "rebuilt RLE RDM"},
     {"VoxelPlugin", "thesis: Voxel Plugin", "culled", "rebuilt culled mesher over an octree"}}};

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

template <class F>
std::vector<double> each(const std::vector<unsigned>& scenarios, F&& value) {
  std::vector<double> out;
  for (const unsigned s : scenarios) out.push_back(value(s));
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

/// A line a category, a column a series.
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

class ThesisFigures {
 public:
  explicit ThesisFigures(const Evidence& evidence)
      : thesis_(evidence.thesis),
        facts_(evidence.findings.rows("facts")),
        times_(evidence.findings.rows("thesis")),
        findings_(evidence.findings) {}

  ReportFigure memory(unsigned group) const {
    const auto scenarios = scenarios_of(group);
    chart::BarChart bytes{
        names_of(scenarios), {}, {"bytes of a chunk of 32³", true}, "memory of a chunk"};
    bytes.series = {
        {"thesis: RLE, 12 B a run, as logged", Role::thesis,
         each(scenarios,
              [&](unsigned s) { return thesis_.value(s, "RLE", "model_memory_logged_mean"); })},
        {"ours: runs, cheapest axis order", Role::ours,
         each(scenarios, [&](unsigned s) { return fact(s, "run_bytes"); })}};
    chart::BarChart solid{names_of(scenarios), {}, {"solid voxels, %"}, "share of solid voxels"};
    solid.series = {{"solid voxels", Role::other, each(scenarios, [&](unsigned s) {
                       return 100 * fact(s, "opaque") / fact(s, "voxels");
                     })}};
    ReportFigure out;
    out.id = fmt::format("memory-group-{}", group);
    out.title =
        fmt::format("Memory of group {}, {} (figures 8.4 to 8.9)", group, kGroupNames[group - 1]);
    const double ours = mean_of(bytes.series[1].values), theirs = mean_of(bytes.series[0].values);
    out.sentence = fmt::format(
        "A chunk takes {} bytes of runs on average: {} % less than a flat array of ours (2 bytes a "
        "voxel). "
        "The thesis' RLE takes {}, {} % "
        "less than its own flat array (8 bytes a voxel).",
        format_value(ours), format_value(100 * (1 - ours / kOurGridBytes)), format_value(theirs),
        format_value(100 * (1 - theirs / kGridBytes)));
    out.steps = {"facts"};
    out.data = table_of("scenario", bytes);
    out.data.columns.push_back("solid voxels, %");
    for (std::size_t i = 0; i < out.data.rows.size(); ++i)
      out.data.rows[i].emplace_back(solid.series[0].values[i]);
    out.picture = chart::frame_of(bytes) + chart::frame_of(solid);
    out.marks = marks_of(scenarios);
    return out;
  }

  ReportFigure vertices(unsigned group) const {
    const auto scenarios = scenarios_of(group);
    chart::BarChart chart{
        names_of(scenarios), {}, {"vertices of a chunk, mean of 27", true}, "vertices of a chunk"};
    for (const Rebuilt& mesher : kRebuilt) {
      chart.series.push_back(
          {mesher.thesis_name,
           mesher.thesis == std::string_view("Grid") ? Role::thesis : Role::other,
           each(scenarios, [&](unsigned s) { return thesis_vertices(s, mesher.thesis); })});
    }
    chart.series.push_back({"ours: RDM from runs", Role::ours, each(scenarios, [&](unsigned s) {
                              return time(s, "rdm", "vertices");
                            })});
    ReportFigure out;
    out.id = fmt::format("vertices-group-{}", group);
    out.title = fmt::format("Vertices of group {}, {} (figures 8.11 to 8.13)", group,
                            kGroupNames[group - 1]);
    out.sentence = fmt::format(
        "Ours needs {} vertices a chunk on average, the thesis' Grid RDM {}, its RLE RDM {} and "
        "Voxel Plugin "
        "{}. {}",
        format_value(mean_of(chart.series[3].values)),
        format_value(mean_of(chart.series[0].values)),
        format_value(mean_of(chart.series[1].values)),
        format_value(mean_of(chart.series[2].values)), agreement(scenarios));
    out.steps = {"thesis"};
    out.data = table_of("scenario", chart);
    for (const Rebuilt& mesher : kRebuilt) {
      out.data.columns.push_back(mesher.our_name);
      for (std::size_t i = 0; i < scenarios.size(); ++i) {
        out.data.rows[i].emplace_back(time(scenarios[i], mesher.ours, "vertices"));
      }
    }
    out.picture = chart::frame_of(chart);
    out.marks = marks_of(scenarios);
    return out;
  }

  ReportFigure phases(unsigned group) const {
    const auto scenarios = scenarios_of(group);
    const auto mean = [&](auto&& value) { return mean_of(each(scenarios, value)); };
    chart::StackChart theirs{
        {}, {}, {"mean ms of a chunk (Unreal Engine, Xeon E3-1240 v5)"}, "phases, thesis"};
    theirs.parts = {{"octree", Role::other, {}},
                    {"meshing", Role::other, {}},
                    {"engine buffers", Role::other, {}},
                    {"other", Role::other, {}}};
    for (const Rebuilt& mesher : kRebuilt) {
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
    for (const Rebuilt& mesher : kRebuilt) add(mesher.our_name, mesher.ours);
    ReportFigure out;
    out.id = fmt::format("phases-group-{}", group);
    out.title = fmt::format("Where the time goes in group {}, {} (figures 8.16 to 8.19)", group,
                            kGroupNames[group - 1]);
    const auto total = [&](const char* mesher) {
      return mean([&](unsigned s) { return time(s, mesher, "mean_ns") / 1000; });
    };
    out.sentence = fmt::format(
        "Ours meshes a chunk in {} µs, with no phase before it and none after: quads are what the "
        "GPU reads. "
        "On the same machine "
        "the rebuilt Grid RDM takes {} µs, RLE RDM {}, and decoding first and meshing with the "
        "fastest dense "
        "mesher {}. "
        "Compare the thesis' milliseconds by their shares only: another machine, and an engine "
        "around them.",
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

  ReportFigure timing(unsigned group) const {
    const auto scenarios = scenarios_of(group);
    chart::RangeChart chart;
    chart.x = {"µs of a chunk, over 27 chunks", true};
    chart.value_names = {"least", "median", "greatest", ""};
    chart.title = "time of a chunk";
    ReportFigure out;
    out.data.columns = {"scenario", "mesher", "least us", "median us", "mean us", "greatest us"};
    double ours_sum = 0, theirs_sum = 0;
    for (const unsigned s : scenarios) {
      const auto thesis_us = [&](const char* metric) {
        return 1000 * thesis_.value(s, "RLE", metric);
      };
      const auto our_us = [&](const char* column) { return time(s, "rdm", column) / 1000; };
      const auto add = [&](const std::string& name, Role role, double low, double middle,
                           double average, double high) {
        chart.names.push_back(fmt::format("{} {}", s, name));
        chart.roles.push_back(role);
        chart.ranges.push_back({low, middle, high, kNone});
        out.data.add({std::to_string(s), name, low, middle, average, high});
      };
      add("ours", Role::ours, our_us("min_ns"), our_us("median_ns"), our_us("mean_ns"),
          our_us("max_ns"));
      add("thesis", Role::thesis, thesis_us("total_min"), thesis_us("total_median"),
          thesis_us("total_mean"), thesis_us("total_max"));
      ours_sum += our_us("mean_ns");
      theirs_sum += thesis_us("total_mean");
    }
    out.id = fmt::format("timing-group-{}", group);
    out.title = fmt::format(
        "Meshing from runs in group {}, {}: least, median, greatest (figures 8.20 and 8.21)", group,
        kGroupNames[group - 1]);
    out.sentence = fmt::format(
        "The thesis' RLE RDM took {} times as long as ours over the group, on another machine and "
        "with "
        "Unreal's buffers: look at "
        "how both rise and fall with the model.",
        format_value(theirs_sum / ours_sum));
    out.steps = {"thesis"};
    out.picture = chart::frame_of(chart);
    out.marks = marks_of(scenarios);
    return out;
  }

  ReportFigure chunk_sizes(unsigned scenario) const {
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
    for (const Rebuilt& mesher : kRebuilt) {
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
        "with Grid "
        "RDM, {} with RLE RDM). "
        "From 32 to 128 the voxels grow 64 times, our time {} times.",
        time_text(at(128)), time_text(kNsPerMs * thesis_.chunk_size_ms(scenario, 128, "Grid")),
        time_text(kNsPerMs * thesis_.chunk_size_ms(scenario, 128, "RLE")),
        format_value(at(128) / at(32)));
    out.marks.push_back(is_noise ? "Ours: one chunk of our noise terrain."
                                 : "Ours: the chunk in the middle; the thesis: the mean of 27.");
    if (is_noise) {
      out.marks.push_back(
          "Scenario 5 is data of side 32 whose generator is not public; ours is measured on our "
          "own noise "
          "terrain instead.");
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

  ReportFigure efficiency() const {
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
    const auto all = scenarios_of_all();
    for (const Rebuilt& mesher : kRebuilt) {
      add(mesher.thesis_name, Role::thesis,
          mean_of(each(
              all, [&](unsigned s) { return thesis_.value(s, mesher.thesis, total_of(mesher)); })),
          mean_of(each(all, [&](unsigned s) { return thesis_vertices(s, mesher.thesis); })));
    }
    const auto add_ours = [&](const std::string& name, Role role, const char* mesher) {
      add(name, role,
          mean_of(each(all, [&](unsigned s) { return time(s, mesher, "mean_ns") / kNsPerMs; })),
          mean_of(each(all, [&](unsigned s) { return time(s, mesher, "vertices"); })));
    };
    for (const Rebuilt& mesher : kRebuilt) add_ours(mesher.our_name, Role::other, mesher.ours);
    add_ours("decode + binary greedy", Role::baseline, "decode_binary");
    add_ours("ours: RDM from runs", Role::ours, "rdm");
    out.id = "efficiency";
    out.title = "Efficiency: time against vertices (figure 8.26)";
    const auto& us = chart.points.back();
    const auto& dense = chart.points[chart.points.size() - 2];
    const auto& rle = chart.points[4];
    out.sentence = fmt::format(
        "The good corner is the lower left. Meshing from runs takes {} µs and {} vertices over all "
        "37 "
        "scenarios; the same machine "
        "needs {} µs to decode and mesh with the fastest dense mesher ({} vertices), and {} µs for "
        "the "
        "rebuilt RLE RDM of the thesis ({} "
        "vertices).",
        format_value(us.x * 1000), format_value(us.y), format_value(dense.x * 1000),
        format_value(dense.y), format_value(rle.x * 1000), format_value(rle.y));
    out.steps = {"thesis"};
    out.picture = chart::frame_of(chart);
    out.marks = {kThesisMeans, kVoxelPluginChunks,
                 "The thesis' points were measured on a Xeon E3-1240 v5 inside Unreal Engine 5.4."};
    return out;
  }

 private:
  double fact(unsigned scenario, const std::string& column) const {
    return facts_.where("scenario", scenario).number(column);
  }
  double time(unsigned scenario, std::string_view mesher, const std::string& column) const {
    return times_.where("scenario", scenario).where("mesher", mesher).number(column);
  }
  /// Voxel Plugin logs 484 events a scenario, of which some 27 are chunks with voxels.
  static const char* total_of(const Rebuilt& mesher) {
    return mesher.thesis == std::string_view("VoxelPlugin") ? "total_mean_nonempty_chunks"
                                                            : "total_mean";
  }
  /// Mean over the 27 chunks; chunks without faces log no line for Voxel Plugin.
  double thesis_vertices(unsigned scenario, std::string_view mesher) const {
    return thesis_.value(scenario, mesher, "vertices_mean");
  }
  static std::vector<unsigned> scenarios_of_all() {
    std::vector<unsigned> out;
    for (unsigned s = 1; s <= kScenarioCount; ++s) out.push_back(s);
    return out;
  }
  /// In how many scenarios our rebuilt meshers give the thesis' mean.
  std::string agreement(const std::vector<unsigned>& scenarios) const {
    std::string out = "Our rebuilt meshers give the thesis' own mean:";
    for (std::size_t i = 0; i < 2; ++i) {
      const auto agrees = [&](unsigned s) {
        return std::abs(time(s, kRebuilt[i].ours, "vertices") -
                        thesis_vertices(s, kRebuilt[i].thesis)) < 0.01;
      };
      out +=
          fmt::format("{} {} in {} of {}", i == 0 ? "" : ",", kRebuilt[i].thesis,
                      std::count_if(scenarios.begin(), scenarios.end(), agrees), scenarios.size());
    }
    return out + ".";
  }

  const ThesisData& thesis_;
  const Rows facts_, times_;
  const Findings& findings_;
};

}  // namespace

ReportSection thesis_section(const Evidence& evidence) {
  const ThesisFigures figures(evidence);
  ReportSection out;
  out.title = "The thesis' figures, again";
  out.introduction =
      "The 37 scenarios of the thesis, every one of their 27 chunks of 32³ but where the side of "
      "the chunk "
      "varies. Its own figures are hatched, "
      "dashed or hollow.";
  out.figures.push_back(figures.efficiency());
  for (const unsigned group : {1U, 2U, 3U}) out.figures.push_back(figures.memory(group));
  for (const unsigned group : {1U, 2U, 3U}) out.figures.push_back(figures.vertices(group));
  for (const unsigned group : {1U, 2U, 3U}) out.figures.push_back(figures.phases(group));
  for (const unsigned group : {2U, 3U}) out.figures.push_back(figures.timing(group));
  for (const unsigned scenario : {1U, 5U, 17U})
    out.figures.push_back(figures.chunk_sizes(scenario));
  return out;
}

}  // namespace runstone::bench
