#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "tests/bench/report/chart/bar_chart.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/frame.hpp"
#include "tests/bench/report/chart/line_chart.hpp"
#include "tests/bench/report/mesher_names.hpp"
#include "tests/bench/report/report_figure.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;
using chart::Role;

/// Draws the worlds across, with a column for each mesher: geometric means of the times over each
/// world's volumes.
ReportFigure worlds(const Evidence& evidence, const char* step, const char* title) {
  const Rows rows = evidence.findings.rows(step);
  chart::BarChart chart{
      rows.kinds("world"), {}, {"µs of a chunk of 32³", true}, "time of a chunk by world"};
  for (const char* mesher : {"rdm", "decode_binary", "grid_binary", "culled"}) {
    chart::Series series{long_name_of(mesher), role_of(mesher), {}};
    if (mesher == std::string_view("grid_binary")) series.role = Role::other;
    for (const std::string& world : chart.categories) {
      const Rows of = rows.where("world", world).where("mesher", mesher);
      series.values.push_back(geometric_mean_of(of.numbers("median_ns")) / 1000);
    }
    chart.series.push_back(std::move(series));
  }
  ReportFigure out;
  out.id = step;
  out.title = title;
  out.steps = {step};
  out.data.columns = {"world", "mesher", "volumes", "median us, geometric mean", "quads, sum"};
  for (const std::string& world : chart.categories) {
    for (const std::string& mesher : rows.kinds("mesher")) {
      const Rows of = rows.where("world", world).where("mesher", mesher);
      out.data.add({world, mesher, static_cast<double>(of.size()),
                    geometric_mean_of(of.numbers("median_ns")) / 1000,
                    sum_of(of.numbers("quads"))});
    }
  }
  std::string ratios;
  for (std::size_t w = 0; w < chart.categories.size(); ++w) {
    ratios += fmt::format("{}{} {}", w == 0 ? "" : ", ", chart.categories[w],
                          format_value(chart.series[1].values[w] / chart.series[0].values[w]));
  }
  out.sentence = fmt::format(
      "Decoding and meshing with the fastest dense mesher takes this many times as long as ours: "
      "{}.",
      ratios);
  out.picture = chart::frame_of(chart);
  return out;
}

ReportFigure orders(const Evidence& evidence) {
  const Rows rows = evidence.findings.rows("orders");
  chart::BarChart runs{
      rows.kinds("world"), {}, {"runs of a chunk, mean", true}, "runs by axis order"};
  chart::BarChart time{runs.categories, {}, {"µs of a chunk, mean", true}, "time by axis order"};
  runs.series = {{"cheapest order", Role::ours, {}}, {"dearest order", Role::other, {}}};
  time.series = {{"ours, cheapest order", Role::ours, {}},
                 {"ours, dearest order", Role::other, {}},
                 {"decode + binary, cheapest order", Role::baseline, {}}};
  ReportFigure out;
  out.data.columns = {"world", "order", "volumes", "runs", "ours us", "decode_binary us"};
  std::vector<double> fewer, faster;
  for (const std::string& world : runs.categories) {
    const Rows in = rows.where("world", world);
    // If all orders of a volume cost the same, none is the worst. The best then also counts as the
    // worst, so that both means are over the same volumes.
    const auto mean = [&](const char* rank, const char* mesher, const char* column) {
      std::vector<double> values;
      for (const std::string& part : in.kinds("part")) {
        const Rows of = in.where("part", part).where("mesher", mesher);
        const Rows ranked = of.where("rank", rank);
        values.push_back((ranked.empty() ? of.where("rank", "best") : ranked).number(column));
      }
      return mean_of(values);
    };
    runs.series[0].values.push_back(mean("best", "rdm", "runs"));
    runs.series[1].values.push_back(mean("worst", "rdm", "runs"));
    time.series[0].values.push_back(mean("best", "rdm", "median_ns") / 1000);
    time.series[1].values.push_back(mean("worst", "rdm", "median_ns") / 1000);
    time.series[2].values.push_back(mean("best", "decode_binary", "median_ns") / 1000);
    fewer.push_back(runs.series[1].values.back() / runs.series[0].values.back());
    faster.push_back(time.series[1].values.back() / time.series[0].values.back());
    for (const std::string& order : in.kinds("order")) {
      const Rows of = in.where("order", order);
      out.data.add({world, order, static_cast<double>(of.where("mesher", "rdm").size()),
                    mean_of(of.where("mesher", "rdm").numbers("runs")),
                    mean_of(of.where("mesher", "rdm").numbers("median_ns")) / 1000,
                    mean_of(of.where("mesher", "decode_binary").numbers("median_ns")) / 1000});
    }
  }
  out.id = "axis-orders";
  out.title = "Axis orders: compression rotation (9.2)";
  out.sentence = fmt::format(
      "The cheapest of the six orders has {} times fewer runs than the dearest (geometric mean "
      "over these worlds) and meshes {} times faster; which one it is differs by chunk, "
      "so each holder picks it when a chunk is made.",
      format_value(geometric_mean_of(fewer)), format_value(geometric_mean_of(faster)));
  out.steps = {"orders"};
  out.picture = chart::frame_of(runs) + chart::frame_of(time);
  return out;
}

ReportFigure dirty_layers(const Evidence& evidence) {
  const Rows rows = evidence.findings.rows("dirty-layers");
  chart::BarChart chart{{}, {}, {"µs"}, "an edit's mesh"};
  chart.series = {{"changed layers only", Role::ours, {}},
                  {"the whole chunk again", Role::baseline, {}}};
  ReportFigure out;
  out.data.columns = {"world", "edge", "changed layers us", "whole chunk us", "bytes a voxel"};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Rows row = rows[i];
    const double edge = row.number("edge"), layers = row.number("edit_ns") / 1000,
                 whole = row.number("edit_full_mesh_ns") / 1000;
    chart.categories.push_back(fmt::format("{} {}", row.text("world"), edge));
    chart.series[0].values.push_back(layers);
    chart.series[1].values.push_back(whole);
    out.data.add({row.text("world"), edge, layers, whole,
                  row.number("memory_bytes") / row.number("voxels")});
  }
  out.id = "dirty-layers";
  out.title = "Dirty layers: what an edit costs to mesh";
  out.sentence = fmt::format(
      "After one voxel changed, the runs are spliced and only the layers it touched are meshed, "
      "neighbours included: {} µs on average where meshing the chunks whole takes {} µs.",
      format_value(mean_of(chart.series[0].values)), format_value(mean_of(chart.series[1].values)));
  out.steps = {"dirty-layers"};
  out.picture = chart::frame_of(chart);
  return out;
}

ReportFigure stacks(const Evidence& evidence) {
  const Rows rows = evidence.findings.rows("edits");
  chart::LineChart chart;
  chart.x = {"edits of one chunk", true};
  chart.y = {"µs", true};
  chart.title = "edits as a stack and one by one";
  const std::array<std::tuple<const char*, Role, const char*>, 4> cases = {
      {{"by hand, as a stack", Role::ours, "mixed edits by hand as a stack"},
       {"by hand, one by one", Role::baseline, "mixed edits by hand one by one"},
       {"by brush, as a stack", Role::ours, "mixed edits by brush as a stack"},
       {"by brush, one by one", Role::baseline, "mixed edits by brush one by one"}}};
  ReportFigure out;
  out.data.columns = {"case", "edits", "median us", "p90 us"};
  const auto at = [&](const char* name, double edits) {
    return rows.where("case", name).where("edits", edits).number("median_us");
  };
  for (const auto& [name, role, key] : cases) {
    chart::LineSeries line{name, role, {}};
    for (const double edits : {1.0, 10.0, 100.0, 1000.0}) {
      line.points.push_back({edits, at(key, edits)});
      out.data.add({name, edits, at(key, edits),
                    rows.where("case", key).where("edits", edits).number("p90_us")});
    }
    chart.lines.push_back(std::move(line));
  }
  out.id = "stacks";
  out.title = "Stacked edits (9.2): one sweep instead of many";
  out.sentence = fmt::format(
      "A thousand edits of one chunk by hand take {} µs as one stack and {} µs one by one; "
      "by brush {} and {}.",
      format_value(at("mixed edits by hand as a stack", 1000)),
      format_value(at("mixed edits by hand one by one", 1000)),
      format_value(at("mixed edits by brush as a stack", 1000)),
      format_value(at("mixed edits by brush one by one", 1000)));
  out.steps = {"edits"};
  out.picture = chart::frame_of(chart);
  return out;
}

}  // namespace

ReportSection beyond_section(const Evidence& evidence) {
  ReportSection out;
  out.title = "Beyond the thesis: worlds, orders, edits";
  out.introduction =
      "Seeded landscapes, a real world made by another program (Luanti), and worlds made to hurt.";
  out.figures = {worlds(evidence, "landscapes", "Places people build in"),
                 worlds(evidence, "adversaries", "Worlds made to hurt"), orders(evidence),
                 dirty_layers(evidence), stacks(evidence)};
  return out;
}

}  // namespace runstone::bench
