#include "bench/frames/frames_result.hpp"
#include "bench/harness/machine_json.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/harness/statistics.hpp"

namespace runstone::bench {
namespace {

constexpr std::array<const char*, 3> kSoftware = {"llvmpipe", "softpipe", "swrast"};

std::string text_of(const std::optional<double>& value, int decimals, const char* none) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : none;
}

template <class T>
nlohmann::ordered_json json_of(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// Meshers with their paths, and worlds, in the order measured.
using Column = std::pair<std::string, std::string>;
std::vector<Column> columns_of(const std::vector<FramesRow>& rows) {
  std::vector<Column> out;
  for (const FramesRow& row : rows) {
    const Column column{row.mesher, row.path};
    if (std::find(out.begin(), out.end(), column) == out.end()) out.push_back(column);
  }
  return out;
}
std::vector<std::string> worlds_of(const std::vector<FramesRow>& rows) {
  std::vector<std::string> out;
  for (const FramesRow& row : rows) {
    if (std::find(out.begin(), out.end(), row.world) == out.end()) out.push_back(row.world);
  }
  return out;
}

const FramesRow* find(const std::vector<FramesRow>& rows, const std::string& world,
                      const Column& column) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const FramesRow& r) {
    return r.world == world && r.mesher == column.first && r.path == column.second;
  });
  return row == rows.end() ? nullptr : &*row;
}

std::string title(const Column& column) {
  return column.second == "plain" ? column.first
                                  : fmt::format("{}, {}", column.first, column.second);
}

/// The means over the rows of one mesher.
class Means {
 public:
  void add(const FramesRow& row, const FramesRow* culled) {
    ++rows_;
    vertices_ += static_cast<double>(row.vertices);
    triangles_ += static_cast<double>(row.triangles);
    bytes_ += static_cast<double>(row.upload_bytes);
    ms_ += row.p50_ms;
    p99_ += row.p99_ms;
    if (culled != nullptr) against_culled_.push_back(row.p50_ms / culled->p50_ms);
    if (row.t_junctions) junctions_.push_back(static_cast<double>(*row.t_junctions));
    add(row.thin_16, thin_16_);
    add(row.thin_100, thin_100_);
    add(row.overdraw, overdraw_);
    add(row.depth_complexity, depth_);
    add(row.lanes, lanes_);
    add(row.seam_pixels, seams_);
    add(row.pinhole_pixels, pinholes_);
  }
  void write(const std::string& name, std::ostream& out) const {
    const auto mean = [&](double sum) { return sum / static_cast<double>(rows_); };
    fmt::print(
        out,
        "| {} | {:.0f} | {:.0f} | {:.0f} | {:.2f} | {:.2f} | {:.0f} | {} | {} | {} | {} | {} | "
        "{} | {} | {} | {} |\n",
        name, mean(vertices_), mean(triangles_), mean(bytes_) / 1024, mean(ms_), mean(p99_),
        1000 / mean(ms_),
        against_culled_.empty() ? "–" : fmt::format("{:.2f}", geometric_mean(against_culled_)),
        text(overdraw_, 2), text(depth_, 2), text(lanes_, 2), text(thin_16_, 1, 100),
        text(thin_100_, 1, 100), text(junctions_, 0), text(seams_, 1), text(pinholes_, 1));
  }

 private:
  static void add(const std::optional<double>& value, std::vector<double>& to) {
    if (value) to.push_back(*value);
  }
  static std::string text(const std::vector<double>& samples, int decimals, double unit = 1) {
    if (samples.empty()) return "–";
    double sum = 0;
    for (const double sample : samples) sum += sample;
    return fmt::format("{:.{}f}", unit * sum / static_cast<double>(samples.size()), decimals);
  }

  std::size_t rows_ = 0;
  double vertices_ = 0, triangles_ = 0, bytes_ = 0, ms_ = 0, p99_ = 0;
  std::vector<double> against_culled_, overdraw_, depth_, lanes_, seams_, pinholes_, junctions_,
      thin_16_, thin_100_;
};

void write_means(const FramesResult& result, const std::vector<Column>& columns,
                 const std::vector<std::string>& worlds, std::ostream& out) {
  std::vector<std::string> common;
  for (const std::string& world : worlds) {
    const bool all = std::all_of(columns.begin(), columns.end(), [&](const Column& column) {
      return find(result.rows, world, column) != nullptr;
    });
    if (all) common.push_back(world);
  }
  fmt::print(out, "\nMeans over the {} world{} that every mesher drew:\n\n", common.size(),
             common.size() == 1 ? "" : "s");
  if (common.empty()) return;
  fmt::print(
      out,
      "| mesher | vertices | triangles | KiB | p50 ms | p99 ms | fps | x culled | overdraw | "
      "depth complexity | lanes | % above 1:16 | % above 1:100 | T-junctions | seam pixels | "
      "pinholes |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Column& column : columns) {
    Means means;
    for (const std::string& world : common) {
      means.add(*find(result.rows, world, column), find(result.rows, world, {"culled", "plain"}));
    }
    means.write(title(column), out);
  }
}

}  // namespace

bool FramesResult::is_software() const {
  return std::any_of(kSoftware.begin(), kSoftware.end(),
                     [&](const char* name) { return gl_renderer.find(name) != std::string::npos; });
}

std::optional<FramesFit> FramesResult::fit() const {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (const FramesRow& row : rows) {
    if (row.path != "plain") continue;
    const double million = static_cast<double>(row.vertices) * 1e-6;
    ++n;
    x += million;
    y += row.p50_ms;
    xx += million * million;
    xy += million * row.p50_ms;
    yy += row.p50_ms * row.p50_ms;
  }
  const double of_x = n * xx - x * x, of_y = n * yy - y * y, of_both = n * xy - x * y;
  if (n < 2 || of_x <= 0) return std::nullopt;
  const double slope = of_both / of_x;
  return FramesFit{(y - slope * x) / n, slope, of_y <= 0 ? 1 : of_both * of_both / (of_x * of_y)};
}

void write_csv(const FramesResult& result, std::ostream& out) {
  fmt::print(out,
             "world,mesher,path,vertices,triangles,upload_bytes,frames,p50_ms,p90_ms,p99_ms,fps,"
             "t_junctions,thin_16,thin_100,covered_pixels,overdraw,depth_complexity,lanes,"
             "seam_pixels,pinhole_pixels\n");
  for (const FramesRow& row : result.rows) {
    fmt::print(out, "{},{},{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.2f},{},{},{},{},{},{},{},{},{}\n",
               row.world, row.mesher, row.path, row.vertices, row.triangles, row.upload_bytes,
               row.frames, row.p50_ms, row.p90_ms, row.p99_ms, row.fps(),
               row.t_junctions ? fmt::format("{}", *row.t_junctions) : "",
               text_of(row.thin_16, 6, ""), text_of(row.thin_100, 6, ""),
               text_of(row.covered_pixels, 1, ""), text_of(row.overdraw, 4, ""),
               text_of(row.depth_complexity, 4, ""), text_of(row.lanes, 4, ""),
               text_of(row.seam_pixels, 2, ""), text_of(row.pinhole_pixels, 2, ""));
  }
}

void write_json(const FramesResult& result, std::ostream& out) {
  nlohmann::ordered_json json = {{"machine", json_of(result.machine)},
                                 {"gl",
                                  {{"renderer", result.gl_renderer},
                                   {"version", result.gl_version},
                                   {"context", result.gl_context},
                                   {"software", result.is_software()}}},
                                 {"width", result.width},
                                 {"height", result.height},
                                 {"frames", result.frames},
                                 {"pictures", result.pictures},
                                 {"rows", nlohmann::ordered_json::array()},
                                 {"skipped", result.skipped}};
  for (const FramesRow& row : result.rows) {
    json["rows"].push_back({{"world", row.world},
                            {"mesher", row.mesher},
                            {"path", row.path},
                            {"vertices", row.vertices},
                            {"triangles", row.triangles},
                            {"upload_bytes", row.upload_bytes},
                            {"frames", row.frames},
                            {"p50_ms", row.p50_ms},
                            {"p90_ms", row.p90_ms},
                            {"p99_ms", row.p99_ms},
                            {"fps", row.fps()},
                            {"t_junctions", json_of(row.t_junctions)},
                            {"thin_16", json_of(row.thin_16)},
                            {"thin_100", json_of(row.thin_100)},
                            {"covered_pixels", json_of(row.covered_pixels)},
                            {"overdraw", json_of(row.overdraw)},
                            {"depth_complexity", json_of(row.depth_complexity)},
                            {"lanes", json_of(row.lanes)},
                            {"seam_pixels", json_of(row.seam_pixels)},
                            {"pinhole_pixels", json_of(row.pinhole_pixels)}});
  }
  if (const auto line = result.fit()) {
    json["fit"] = {{"intercept_ms", line->intercept_ms},
                   {"ms_per_million_vertices", line->ms_per_million_vertices},
                   {"r2", line->r2}};
  }
  out << json.dump(1) << '\n';
}

void write_tables(const FramesResult& result, std::ostream& out) {
  fmt::print(out, "{}; OpenGL {}; {}\n", result.gl_renderer, result.gl_version, result.gl_context);
  fmt::print(out,
             "{} frames of an orbit at {}x{}, {} pictures compared; the meshers' frames shuffled\n",
             result.frames, result.width, result.height, result.pictures);
  if (result.is_software()) {
    fmt::print(out, "The processor draws: frame times follow vertices far more than on a GPU.\n");
  }
  const auto columns = columns_of(result.rows);
  const auto worlds = worlds_of(result.rows);
  write_means(result, columns, worlds, out);
  if (const auto line = result.fit()) {
    fmt::print(
        out, "\nOver all plain rows: p50 = {:.2f} ms + {:.2f} ms a million vertices, r² = {:.2f}\n",
        line->intercept_ms, line->ms_per_million_vertices, line->r2);
  }
  fmt::print(out, "\nFrames a second (1000 / p50 ms):\n\n| world |");
  for (const Column& column : columns) fmt::print(out, " {} |", title(column));
  fmt::print(out, "\n|---|");
  for (std::size_t i = 0; i < columns.size(); ++i) fmt::print(out, "---|");
  fmt::print(out, "\n");
  for (const std::string& world : worlds) {
    fmt::print(out, "| {} |", world);
    for (const Column& column : columns) {
      const FramesRow* const row = find(result.rows, world, column);
      fmt::print(out, " {} |", row == nullptr ? "–" : fmt::format("{:.0f}", row->fps()));
    }
    fmt::print(out, "\n");
  }
  for (const std::string& what : result.skipped) fmt::print(out, "\nskipped: {}", what);
  if (!result.skipped.empty()) fmt::print(out, "\n");
}

}  // namespace runstone::bench
