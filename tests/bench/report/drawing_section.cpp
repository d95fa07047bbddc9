#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/bench/report/chart/bar_chart.hpp"
#include "tests/bench/report/chart/format_value.hpp"
#include "tests/bench/report/chart/frame.hpp"
#include "tests/bench/report/chart/heat_map.hpp"
#include "tests/bench/report/ranking.hpp"
#include "tests/bench/report/report_figure.hpp"

namespace runstone::bench {
namespace {

using chart::format_value;
using chart::Role;

/// Means of plain frames, over the worlds that all of these meshers drew. A mesher that drew fewer
/// worlds than most, since its meshes are too large, is left out.
class Frames {
 public:
  explicit Frames(const Findings& findings)
      : rows_(findings.rows("frames").where("path", "plain")) {
    std::size_t most = 0;
    for (const std::string& mesher : rows_.kinds("mesher"))
      most = std::max(most, rows_.where("mesher", mesher).size());
    for (const std::string& mesher : rows_.kinds("mesher")) {
      if (mesher == "none") continue;  // the empty scene
      const bool drew_most = 4 * rows_.where("mesher", mesher).size() >= 3 * most;
      (drew_most ? meshers_ : left_out_).push_back(mesher);
    }
    for (const std::string& world : rows_.kinds("world")) {
      const Rows at = rows_.where("world", world);
      const bool all_drew =
          std::all_of(meshers_.begin(), meshers_.end(), [&](const std::string& mesher) {
            return at.where("mesher", mesher).number("vertices") > 0;
          });
      if (all_drew) worlds_.push_back(world);
    }
  }
  const Rows& rows() const { return rows_; }
  const std::vector<std::string>& meshers() const { return meshers_; }
  const std::vector<std::string>& left_out() const { return left_out_; }
  const std::vector<std::string>& worlds() const { return worlds_; }
  std::vector<double> of(const std::string& mesher, const char* column) const {
    std::vector<double> out;
    for (const std::string& world : worlds_) {
      out.push_back(rows_.where("world", world).where("mesher", mesher).number(column));
    }
    return out;
  }

 private:
  Rows rows_;
  std::vector<std::string> meshers_, left_out_, worlds_;
};

template <class F>
chart::RankChart ranked(const Frames& frames, const chart::Axis& axis, F&& value) {
  std::vector<Ranked> all;
  for (const std::string& mesher : frames.meshers()) all.push_back({mesher, value(mesher)});
  rank(all);
  return chart_of(all, axis);
}

DataTable all_columns(const Rows& rows) {
  const std::array<const char*, 15> numbers = {
      "vertices", "triangles",   "upload_bytes",  "p50_ms",   "p90_ms",   "p99_ms",
      "fps",      "t_junctions", "thin_16",       "thin_100", "overdraw", "depth_complexity",
      "lanes",    "seam_pixels", "pinhole_pixels"};
  DataTable out{{"world", "mesher", "path"}, {}};
  out.columns.insert(out.columns.end(), numbers.begin(), numbers.end());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Rows row = rows[i];
    std::vector<DataTable::Value> line = {row.text("world"), row.text("mesher"), row.text("path")};
    for (const char* column : numbers) line.emplace_back(row.number(column));
    out.add(std::move(line));
  }
  return out;
}

std::vector<std::string> marks_of(const Findings& findings, const Frames& frames) {
  const Rows setting = findings.object("frames", ""), gl = findings.object("frames", "gl");
  if (setting.empty()) return {};
  std::vector<std::string> out = {fmt::format("Drawn by {}, {} by {} pixels.", gl.text("renderer"),
                                              format_value(setting.number("width")),
                                              format_value(setting.number("height")))};
  if (gl.number("software") == 1) {
    out.push_back(
        "The processor draws here, so a frame is bound by vertices far more than on a GPU.");
  }
  if (!frames.left_out().empty()) {
    out.push_back(fmt::format("Too large to be drawn in most worlds, so not in the means: {}.",
                              fmt::join(frames.left_out(), ", ")));
  }
  return out;
}

ReportFigure frame_times(const Evidence& evidence, const Frames& frames) {
  const auto ms = [&](const std::string& mesher) {
    return geometric_mean_of(frames.of(mesher, "p50_ms"));
  };
  ReportFigure out;
  out.id = "frames";
  out.title = "Frame time by mesher (8.5)";
  out.sentence = fmt::format(
      "The same chunks, shader and vertex format: only the polygons differ. "
      "A frame takes {} ms (geometric mean of {} worlds) with our mesh, {} with culled faces, "
      "{} with the thesis' RLE RDM.",
      format_value(ms("rdm")), frames.worlds().size(), format_value(ms("culled")),
      format_value(ms("rle_rdm")));
  out.steps = {"frames"};
  out.picture =
      chart::frame_of(ranked(frames, {"ms a frame, p50, geometric mean over worlds"}, ms));
  out.data = all_columns(evidence.findings.rows("frames"));
  out.marks = marks_of(evidence.findings, frames);
  return out;
}

ReportFigure thesis_frames(const Evidence& evidence, const Frames& frames) {
  const std::array<unsigned, 4> scenarios = {13, 17, 23, 33};
  struct FramesPair {
    const char *thesis, *ours, *name;
  };
  constexpr std::array<FramesPair, 3> kPairs = {
      {{"Grid", "grid_rdm", "Grid RDM"},
       {"RLE", "rle_rdm", "RLE RDM"},
       {"VoxelPlugin", "culled", "culled (Voxel Plugin)"}}};
  chart::BarChart ours{{}, {}, {"frames a second, here", true}, "frames a second, ours"};
  chart::BarChart theirs{
      {}, {}, {"frames a second, RTX 3050 in Unreal Engine"}, "frames a second, thesis"};
  ReportFigure out;
  out.data.columns = {"scenario", "mesher", "fps here", "fps of the thesis"};
  const auto fps = [&](unsigned s, const char* mesher) {
    return frames.rows()
        .where("world", fmt::format("scenario_{}", s))
        .where("mesher", mesher)
        .number("fps");
  };
  for (const unsigned s : scenarios) {
    ours.categories.push_back(std::to_string(s));
    theirs.categories.push_back(std::to_string(s));
  }
  ours.series.push_back({"ours: RDM from runs", Role::ours, {}});
  for (const unsigned s : scenarios) ours.series.back().values.push_back(fps(s, "rdm"));
  for (const FramesPair& pair : kPairs) {
    ours.series.push_back({fmt::format("rebuilt {}", pair.name), Role::other, {}});
    theirs.series.push_back({fmt::format("thesis: {}", pair.name),
                             theirs.series.empty() ? Role::thesis : Role::other,
                             {}});
    for (const unsigned s : scenarios) {
      ours.series.back().values.push_back(fps(s, pair.ours));
      theirs.series.back().values.push_back(evidence.thesis.value(s, pair.thesis, "fps_mean"));
      out.data.add({std::to_string(s), pair.name, ours.series.back().values.back(),
                    theirs.series.back().values.back()});
    }
  }
  for (const unsigned s : scenarios)
    out.data.add({std::to_string(s), "RDM from runs", fps(s, "rdm"), std::nan("")});
  out.id = "fps";
  out.title = "Frames a second in the thesis' four scenarios (figure 8.14)";
  out.sentence = fmt::format(
      "Scenario 23 shows what merging and culling buy: {} frames a second with our mesh, "
      "{} with the rebuilt Grid RDM, {} with culled faces; "
      "the thesis has {} with Grid RDM and {} with its RLE RDM.",
      format_value(fps(23, "rdm")), format_value(fps(23, "grid_rdm")),
      format_value(fps(23, "culled")), format_value(evidence.thesis.value(23, "Grid", "fps_mean")),
      format_value(evidence.thesis.value(23, "RLE", "fps_mean")));
  out.steps = {"frames"};
  out.picture = chart::frame_of(ours) + chart::frame_of(theirs);
  out.marks = marks_of(evidence.findings, frames);
  out.marks.push_back(
      "The thesis' empty scene ran at 77; Voxel Plugin drew lower levels of detail farther away.");
  return out;
}

ReportFigure seams(const Evidence& evidence, const Frames& frames) {
  const auto mean = [&](const std::string& mesher, const char* column) {
    return mean_of(frames.of(mesher, column));
  };
  const chart::RankChart pinholes =
      ranked(frames, {"pinholes a picture, pixels, mean over worlds"},
             [&](const std::string& mesher) { return mean(mesher, "pinhole_pixels"); });
  const chart::RankChart lanes =
      ranked(frames, {"lanes of 2 x 2 blocks that shade, a fragment: 1 is ideal"},
             [&](const std::string& mesher) { return mean(mesher, "lanes"); });
  ReportFigure out;
  out.id = "seams";
  out.title = "What T-junctions and thin triangles do on screen (4.2.1, 4.2.2)";
  out.sentence = fmt::format(
      "Pixels inside a plane that differ from the picture of culled faces: "
      "{} a picture with our mesh, {} with Poly2Tri. A GPU shades in blocks of 2 x 2, "
      "so it shades more lanes than fragments along every edge: {} lanes a fragment with our mesh, "
      "{} with culled faces.",
      format_value(mean("rdm", "pinhole_pixels")), format_value(mean("poly2tri", "pinhole_pixels")),
      format_value(mean("rdm", "lanes")), format_value(mean("culled", "lanes")));
  out.steps = {"frames"};
  out.picture = chart::frame_of(pinholes) + chart::frame_of(lanes);
  out.data = all_columns(frames.rows());
  out.marks = marks_of(evidence.findings, frames);
  return out;
}

ReportFigure storage(const Evidence& evidence) {
  const Rows rows = evidence.findings.rows("storage");
  const std::array<std::pair<const char*, const char*>, 6> columns = {{{"bytes", "bytes"},
                                                                       {"read_ns", "random read"},
                                                                       {"walk_ns", "walk"},
                                                                       {"edit_ns", "one edit"},
                                                                       {"brush_ns", "brush"},
                                                                       {"build_ns", "build"}}};
  chart::HeatMap chart;
  chart.rows = rows.kinds("store");
  chart.value = {"times the best in its column", true};
  chart.title = "ways to store voxels";
  ReportFigure out;
  out.data.columns = {"store"};
  for (const auto& [column, name] : columns) {
    chart.columns.emplace_back(name);
    out.data.columns.emplace_back(column);
  }
  std::vector<double> figures;
  for (const std::string& store : chart.rows) {
    std::vector<DataTable::Value> line = {store};
    for (const auto& [column, name] : columns) {
      figures.push_back(geometric_mean_of(rows.where("store", store).numbers(column)));
      line.emplace_back(figures.back());
    }
    out.data.add(std::move(line));
  }
  std::string best;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    double least = std::nan("");
    std::size_t winner = 0;
    for (std::size_t r = 0; r < chart.rows.size(); ++r) {
      const double value = figures[r * columns.size() + c];
      if (std::isnan(value) || !(std::isnan(least) || value < least)) continue;
      least = value;
      winner = r;
    }
    if (!chart.rows.empty())
      best += fmt::format("{}{}: {}", c == 0 ? "" : "; ", chart.columns[c], chart.rows[winner]);
    for (std::size_t r = 0; r < chart.rows.size(); ++r) figures[r * columns.size() + c] /= least;
  }
  chart.values = figures;
  out.id = "storage";
  out.title = "Ways to store voxels (3.3, 3.4, 3.7)";
  out.sentence = fmt::format("Who is best at what, geometric means over scenarios and worlds: {}.",
                             best.empty() ? "not measured" : best);
  out.steps = {"storage"};
  out.picture = chart::frame_of(chart);
  out.marks = {
      "Runs are ours, in their cheapest order. A brush is a sphere of radius 5; "
      "times are of a whole edit."};
  return out;
}

}  // namespace

ReportSection drawing_section(const Evidence& evidence) {
  const Frames frames(evidence.findings);
  ReportSection out;
  out.title = "Drawing and storing";
  out.introduction =
      "What the meshes cost to draw, and what other ways to keep the same voxels cost.";
  out.figures = {frame_times(evidence, frames), thesis_frames(evidence, frames),
                 seams(evidence, frames), storage(evidence)};
  return out;
}

}  // namespace runstone::bench
