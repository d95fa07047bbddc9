#include "tests/bench/network/siege_charts.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <utility>

#include "tests/bench/network/attack.hpp"
#include "tests/bench/report/chart/line_chart.hpp"
#include "tests/bench/report/chart/svg_file.hpp"

namespace runstone::bench {
namespace {

/// Returns a line with a point in the middle of each window.
template <class F>
chart::LineSeries siege_line(const SiegeResult& result, std::string name, chart::Role role,
                             F&& value) {
  chart::LineSeries out{std::move(name), role, {}};
  for (const SiegeWindow& window : result.windows) {
    out.points.push_back({(window.from_s + window.to_s) / 2, value(window)});
  }
  return out;
}

chart::LineChart siege_chart(const SiegeResult& result, const NetOptions& options, const char* what,
                             chart::Axis y) {
  chart::LineChart out;
  out.title =
      fmt::format("{}: {} builders, {} attackers", what, options.siege_bots, options.attackers);
  out.has_heading = true;
  out.x = {"time since the server started, s"};
  out.y = std::move(y);
  for (const SiegeWindow& window : result.windows) {
    if (window.attack != kQuiet) out.spans.push_back({window.from_s, window.to_s, window.attack});
  }
  return out;
}

Done write_siege_chart(const chart::LineChart& drawn, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << chart::svg_file_of(svg_of(drawn)) << std::flush;
  if (!out) return Unexpected<std::string>{"cannot write " + file.string()};
  return {};
}

}  // namespace

Done write_siege_charts(const SiegeResult& result, const NetOptions& options,
                        const std::string& folder) {
  using chart::Role;
  auto latency = siege_chart(result, options, "Latency of edits", {"latency, ms", true});
  latency.lines = {siege_line(result, "p99", Role::ours,
                              [](const SiegeWindow& window) { return window.seen.p99_ms; }),
                   siege_line(result, "p50", Role::other,
                              [](const SiegeWindow& window) { return window.seen.p50_ms; })};
  auto memory = siege_chart(result, options, "Memory of the server", {"resident memory, MB"});
  memory.lines = {siege_line(result, "server", Role::ours,
                             [](const SiegeWindow& window) { return window.resident_mb; })};
  auto disk = siege_chart(result, options, "Disk writes of the server", {"written, KB/s"});
  disk.lines = {siege_line(result, "server", Role::ours,
                           [](const SiegeWindow& window) { return window.disk_kb_s; })};
  const std::filesystem::path into = folder;
  std::error_code failed;
  std::filesystem::create_directories(into, failed);  // a failure shows when a file is written
  for (const auto& [name, drawn] : {std::pair{"siege-p99.svg", &latency},
                                    {"siege-memory.svg", &memory},
                                    {"siege-disk.svg", &disk}}) {
    if (const auto done = write_siege_chart(*drawn, into / name); !done) return done;
  }
  return {};
}

}  // namespace runstone::bench
