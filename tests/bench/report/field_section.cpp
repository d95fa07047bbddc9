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
#include "tests/bench/report/chart/rank_chart.hpp"
#include "tests/bench/report/mesher_names.hpp"
#include "tests/bench/report/report_figure.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;

/// A mesher and one figure of it.
struct Ranked {
  std::string mesher;
  double value = 0;
  std::string note = {};
};

/// Best first; what was not measured last.
void rank(std::vector<Ranked>& all) {
  std::stable_sort(all.begin(), all.end(), [](const Ranked& a, const Ranked& b) {
    return !std::isnan(a.value) && (std::isnan(b.value) || a.value < b.value);
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

DataTable table_of(const std::vector<Ranked>& all, const char* column) {
  DataTable out{{"mesher", column}, {}};
  for (const Ranked& each : all) out.add({each.mesher, each.value});
  return out;
}

double value_of(const std::vector<Ranked>& all, std::string_view mesher) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Ranked& r) { return r.mesher == mesher; });
  return found == all.end() ? std::numeric_limits<double>::quiet_NaN() : found->value;
}

class FieldFigures {
 public:
  explicit FieldFigures(const Evidence& evidence)
      : findings_(evidence.findings),
        rows_(evidence.findings.rows("meshers")),
        meshers_(rows_.kinds("mesher")) {}

  ReportFigure time() const {
    auto ranked = each_mesher([this](const Rows& rows) {
      return rows.size() == kScenarioCount ? geometric_mean_of(rows.numbers("median_ns")) / 1000
                                           : std::numeric_limits<double>::quiet_NaN();
    });
    const double ours = value_of(ranked, "rdm");
    for (Ranked& each : ranked) {
      if (each.mesher != "rdm") each.note = fmt::format("{} × ours", format_value(each.value / ours));
    }
    ReportFigure out = figure("meshers-time", "All meshers: time", ranked,
                              {"µs of a chunk of 32³, geometric mean of 37 scenarios", true}, "us");
    out.sentence = fmt::format(
        "From compressed runs ours takes {} µs. The fastest dense mesher takes {} µs from the same runs, and "
        "{} µs where somebody "
        "has already made it a dense grid.",
        format_value(ours), format_value(value_of(ranked, "decode_binary")),
        format_value(value_of(ranked, "grid_binary")));
    out.marks = {"The chunk in the middle of 27; one core; runs in their cheapest order.",
                 "Meshers marked 'grid ready' are not charged for making the grid out of what is stored."};
    return out;
  }

  ReportFigure map() const {
    chart::HeatMap chart;
    chart.value = {"µs of a chunk", true};
    chart.title = "time of every mesher in every scenario";
    ReportFigure out;
    out.data.columns = {"scenario", "mesher",    "us",          "quads",
                        "vertices", "triangles", "t_junctions", "storage_bytes"};
    for (unsigned s = 1; s <= kScenarioCount; ++s) chart.columns.push_back(std::to_string(s));
    for (const std::string& mesher : meshers_) {
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
        "In {} of 37 scenarios meshing from runs beats decoding and meshing with the fastest dense mesher.",
        wins);
    out.steps = {"meshers"};
    out.picture = chart::frame_of(chart);
    out.marks = {"Empty cells took longer than 5 s."};
    return out;
  }

  ReportFigure triangles() const {
    auto ranked = each_mesher([](const Rows& rows) { return sum_of(rows.numbers("triangles")); });
    std::erase_if(ranked, [](const Ranked& each) { return each.mesher != "rdm" && is_variant(each.mesher); });
    const double optimum = value_of(ranked, "optimal_greedy");
    for (Ranked& each : ranked) each.note = fmt::format("{} × optimum", format_value(each.value / optimum));
    ReportFigure out = figure("meshers-triangles", "All meshers: triangles", ranked,
                              {"triangles, sum over 37 scenarios", true}, "triangles");
    out.sentence = fmt::format(
        "No mesher that draws rectangles can use fewer than the optimum of {}; ours uses {} times that.",
        format_value(optimum), format_value(value_of(ranked, "rdm") / optimum));
    out.marks = {"Monotone and Poly2Tri draw polygons, not rectangles, so the optimum does not bind them."};
    return out;
  }

  ReportFigure t_junctions() const {
    auto ranked = each_mesher([](const Rows& rows) { return sum_of(rows.numbers("t_junctions")); });
    std::erase_if(ranked, [](const Ranked& each) { return each.mesher != "rdm" && is_variant(each.mesher); });
    ReportFigure out = figure("t-junctions", "All meshers: T-junctions (4.2.1)", ranked,
                              {"T-junctions, sum over 37 scenarios"}, "t_junctions");
    out.sentence = fmt::format(
        "A vertex inside another polygon's edge can flicker as a seam. Merging makes them: ours {}, the "
        "culled mesher {}; "
        "monotone ({}) and Poly2Tri ({}) lessen them within a plane and keep them between planes.",
        format_value(value_of(ranked, "rdm")), format_value(value_of(ranked, "culled")),
        format_value(value_of(ranked, "monotone")), format_value(value_of(ranked, "poly2tri")));
    return out;
  }

 private:
  template <class F>
  std::vector<Ranked> each_mesher(F&& value) const {
    std::vector<Ranked> out;
    for (const std::string& mesher : meshers_) out.push_back({mesher, value(rows_.where("mesher", mesher))});
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

  const Findings& findings_;
  const Rows rows_;
  const std::vector<std::string> meshers_;
};

}  // namespace

ReportSection field_section(const Evidence& evidence) {
  const FieldFigures figures(evidence);
  ReportSection out;
  out.title = "The whole field";
  out.introduction =
      "Every algorithm of the thesis' chapter 4.2, rebuilt and held to the same oracle, on the same chunks.";
  out.figures = {figures.time(), figures.map(), figures.triangles(), figures.t_junctions()};
  return out;
}

}  // namespace runstone::bench
