#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/generate/scenarios/scenario_model.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/frame.hpp"
#include "tests/bench/report/chart/heat_map.hpp"
#include "tests/bench/report/mesher_names.hpp"
#include "tests/bench/report/mesher_totals.hpp"
#include "tests/bench/report/number_text.hpp"
#include "tests/bench/report/ranking.hpp"
#include "tests/bench/report/report_figure.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;

/// Returns a text that is short enough for a cell: "1.9k" for 1,940.
std::string cell_text(double us) {
  return us < 1000 ? format_value(us) : fmt::format("{:.2g}k", us / 1000);
}

DataTable table_of(const std::vector<Ranked>& all, const char* column) {
  DataTable out{{"mesher", column}, {}};
  for (const Ranked& each : all) out.add({each.mesher, each.value});
  return out;
}

class FieldFigures {
 public:
  explicit FieldFigures(const Evidence& evidence)
      : rows_(evidence.findings.rows("meshers")), totals_(mesher_totals(rows_)) {}

  ReportFigure time() const {
    auto ranked = each_mesher([](const MesherTotal& total) { return total.mean_ns / 1000; });
    const double ours = total_of(totals_, "rdm").mean_ns;
    for (Ranked& each : ranked) {
      if (each.mesher != "rdm")
        each.note = fmt::format("{} × ours", format_value(each.value * 1000 / ours));
    }
    ReportFigure out = figure("meshers-time", "All meshers: time", ranked,
                              {"µs of a chunk of 32³, geometric mean of 37 scenarios", true}, "us");
    out.sentence = fmt::format(
        "From compressed runs ours takes {}. The fastest dense mesher takes {} from the same runs, "
        "and {} where somebody has already made it a dense grid. "
        "By the sum of all scenarios, in which the slowest weigh most, it is {} against {}.",
        time_text(ours), time_text(total_of(totals_, "decode_binary").mean_ns),
        time_text(total_of(totals_, "grid_binary").mean_ns),
        time_text(total_of(totals_, "rdm").sum_ns),
        time_text(total_of(totals_, "decode_binary").sum_ns));
    out.marks = {
        "The chunk in the middle of 27; one core; runs in their cheapest order.",
        "Meshers marked 'grid ready' are not charged for making the grid out of what is stored."};
    return out;
  }

  ReportFigure map() const {
    chart::HeatMap chart;
    chart.value = {"µs of a chunk", true};
    chart.title = "time of every mesher in every scenario";
    chart.text = cell_text;
    ReportFigure out;
    out.data.columns = {"scenario", "mesher",    "us",          "quads",
                        "vertices", "triangles", "t_junctions", "storage_bytes"};
    for (unsigned s = 1; s <= kScenarioCount; ++s) chart.columns.push_back(std::to_string(s));
    for (const std::string& mesher : rows_.kinds("mesher")) {
      chart.rows.push_back(short_name_of(mesher));
      for (const std::string& scenario : chart.columns) {
        const Rows row = rows_.where("mesher", mesher).where("part", scenario);
        chart.values.push_back(row.number("median_ns") / 1000);
        out.data.add({scenario, mesher, row.number("median_ns") / 1000, row.number("quads"),
                      row.number("vertices"), row.number("triangles"), row.number("t_junctions"),
                      row.number("storage_bytes")});
      }
    }
    out.id = "meshers-scenarios";
    out.title = "All meshers over all scenarios";
    std::size_t wins = 0;
    for (const std::string& scenario : chart.columns) {
      const Rows in = rows_.where("part", scenario);
      const double ours = in.where("mesher", "rdm").number("median_ns");
      wins += ours < in.where("mesher", "decode_binary").number("median_ns") ? 1U : 0U;
    }
    out.sentence = fmt::format(
        "In {} of 37 scenarios meshing from runs beats decoding and meshing with the fastest dense "
        "mesher.",
        wins);
    out.steps = {"meshers"};
    out.picture = chart::frame_of(chart);
    out.marks = {"Empty cells took longer than 5 s."};
    return out;
  }

  ReportFigure triangles() const {
    auto ranked = each_mesher([](const MesherTotal& total) { return total.triangles; });
    std::erase_if(ranked, [](const Ranked& each) { return is_variant(each.mesher); });
    const double optimum = total_of(totals_, "optimal_greedy").triangles;
    for (Ranked& each : ranked)
      each.note = fmt::format("{} × optimum", ratio_text(each.value / optimum));
    ReportFigure out = figure("meshers-triangles", "All meshers: triangles", ranked,
                              {"triangles, sum over 37 scenarios", true}, "triangles");
    out.sentence = fmt::format(
        "No mesher that draws the exposed faces as rectangles can use fewer than the optimum of {} "
        "triangles; ours uses {} times that.",
        count_text(optimum), ratio_text(total_of(totals_, "rdm").triangles / optimum));
    out.marks = {
        "Monotone and Poly2Tri draw polygons, not rectangles, "
        "and run strips over hidden faces draw more than is exposed: "
        "the optimum does not bind them."};
    return out;
  }

  ReportFigure t_junctions() const {
    auto ranked = each_mesher([](const MesherTotal& total) { return total.t_junctions; });
    std::erase_if(ranked, [](const Ranked& each) { return is_variant(each.mesher); });
    ReportFigure out = figure("t-junctions", "All meshers: T-junctions (4.2.1)", ranked,
                              {"T-junctions, sum over 37 scenarios"}, "t_junctions");
    const auto of = [this](const char* mesher) {
      return count_text(total_of(totals_, mesher).t_junctions);
    };
    out.sentence = fmt::format(
        "A vertex inside another polygon's edge can flicker as a seam. "
        "Merging makes them: ours {}, the culled mesher {}; "
        "monotone ({}) and Poly2Tri ({}) lessen them within a plane and keep them between planes.",
        of("rdm"), of("culled"), of("monotone"), of("poly2tri"));
    return out;
  }

 private:
  template <class F>
  std::vector<Ranked> each_mesher(F&& value) const {
    std::vector<Ranked> out;
    for (const MesherTotal& total : totals_) out.push_back({total.mesher, value(total)});
    return out;
  }
  static ReportFigure figure(const char* id, const char* title, std::vector<Ranked> ranked,
                             const chart::Axis& axis, const char* column) {
    rank(ranked);
    ReportFigure out;
    out.id = id;
    out.title = title;
    out.steps = {"meshers"};
    out.data = table_of(ranked, column);
    out.picture = chart::frame_of(chart_of(ranked, axis));
    return out;
  }

  const Rows rows_;
  const std::vector<MesherTotal> totals_;
};

}  // namespace

ReportSection field_section(const Evidence& evidence) {
  const FieldFigures figures(evidence);
  ReportSection out;
  out.title = "The whole field";
  out.introduction =
      "Every algorithm of the thesis' chapter 4.2, rebuilt and checked with the same oracle, "
      "on the same chunks.";
  out.figures = {figures.time(), figures.map(), figures.triangles(), figures.t_junctions()};
  return out;
}

}  // namespace runstone::bench
