#include "bench/network/horizon_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/harness/statistics.hpp"

namespace runstone::bench {
namespace {

constexpr unsigned kFarViewRadiusV = 3;  // chunks

/// The view radius in chunks, and the levels of tiles that are measured.
struct FarViews {
  unsigned radius = 8;
  std::array<unsigned, 4> levels = {0, 4, 6, 7};
  /// Returns how far a view with these levels sees, in voxels, at chunks of 32 voxels.
  unsigned reach(unsigned levels_of_view) const { return radius * 32U << levels_of_view; }
};

FarViews views_of(const NetOptions& options) {
  return options.quick ? FarViews{3, {0, 1, 2, 3}} : FarViews{};
}

constexpr double kHorizonSeconds = 120;
constexpr double kCoarseMsMax = 1'000, kAllMsMax = 5'000;  // the targets on broadband
// The targets of a landscape. The third of its views is measured.
constexpr double kLandscapeMsMax = 6'000, kLandscapeBytesMax = 2e6;
constexpr std::size_t kLandscapeView = 2;

/// The generator and the levels of a join that is measured.
struct HorizonView {
  const char* generator;
  unsigned levels;
};

struct HorizonJoin {
  double near_ms = 0, coarse_ms = 0, all_ms = 0;
  double tiles = 0, bytes = 0, memory_mb = 0;
};

Result<HorizonJoin, std::string> horizon_once(Testbed& testbed, TestbedLink& link,
                                              const HorizonView& view) {
  const auto failed = [](const auto& what) { return failure(what.error()); };
  auto server = testbed.start_server(link, testbed.fresh("world"), {"--generator", view.generator});
  if (!server) return failed(server);
  const std::string script = testbed.fresh("script.txt"),
                    report_file = testbed.fresh("report.json");
  write_text(script, fmt::format("wait horizon {}\nquit\n", kHorizonSeconds));
  auto client = testbed.start_client(
      link, "runstone-client",
      {"--connect", server->address, "--name", "newcomer", "--no-render", "--view",
       fmt::to_string(views_of(testbed.options()).radius), "--view-vertical",
       fmt::to_string(kFarViewRadiusV), "--far-levels", fmt::to_string(view.levels), "--script",
       script, "--report", report_file});
  if (!client) return failed(client);
  if (const auto ended = testbed.finish(**client, 2 * kHorizonSeconds); !ended)
    return failed(ended);
  if (const auto ended = testbed.stop_server(*server); !ended) return failed(ended);
  const auto report = read_report(report_file);
  if (!report) return failed(report);
  const nlohmann::json& far = (*report)["far_ground"];
  if (view.levels > 0 && far["all_ms"].is_null()) return failure("a join never saw its horizon");
  return HorizonJoin{number_in((*report)["join"]["near"]["most_ms"]),
                     number_in(far["coarse_ms"]),
                     number_in(far["all_ms"]),
                     number_in(far["tiles"]),
                     number_in((*report)["net"]["bytes_received"]),
                     number_in(far["bytes"]) / 1e6};
}

Result<std::vector<HorizonJoin>, std::string> horizons_of(Testbed& testbed,
                                                          const test::LinkProfile& profile,
                                                          const HorizonView& view) {
  std::vector<HorizonJoin> out;
  for (unsigned i = 0; i < testbed.options().repetitions; ++i) {
    auto link = testbed.make_link(profile);
    if (!link) return failure(link.error());
    const auto join = horizon_once(testbed, **link, view);
    if (!join) return failure(join.error());
    out.push_back(*join);
  }
  return out;
}

double median_of(const std::vector<HorizonJoin>& joins, double HorizonJoin::* what) {
  std::vector<double> samples;
  for (const HorizonJoin& join : joins) samples.push_back(join.*what);
  return median(samples);
}

double slowest_of(const std::vector<HorizonJoin>& joins, double HorizonJoin::* what) {
  double out = 0;
  for (const HorizonJoin& join : joins) out = std::max(out, join.*what);
  return out;
}

void add_targets(const std::vector<HorizonJoin>& joins, unsigned reach, NetFindings& findings) {
  const auto add = [&](const char* what, double HorizonJoin::* time, double most) {
    const double slowest = slowest_of(joins, time);
    findings.targets.push_back(
        {fmt::format("first join on broadband, {} voxels far: horizon {}", reach, what),
         number_text(most) + " ms",
         fmt::format("{} ms; the slowest {} ms", number_text(median_of(joins, time)),
                     number_text(slowest)),
         slowest <= most ? Verdict::met : Verdict::missed});
  };
  add("complete, coarse", &HorizonJoin::coarse_ms, kCoarseMsMax);
  add("complete at its levels", &HorizonJoin::all_ms, kAllMsMax);
}

void add_landscape_targets(const std::vector<HorizonJoin>& joins, NetFindings& findings) {
  const auto add = [&](const char* what, const char* unit, double HorizonJoin::* value, double most,
                       double scale) {
    const double slowest = slowest_of(joins, value);
    findings.targets.push_back(
        {fmt::format("first join of a landscape on broadband, 16384 voxels far: {}", what),
         fmt::format("{} {}", number_text(most / scale), unit),
         fmt::format("{} {}; the most {} {}", number_text(median_of(joins, value) / scale), unit,
                     number_text(slowest / scale), unit),
         slowest <= most ? Verdict::met : Verdict::missed});
  };
  add("horizon complete at its levels", "s", &HorizonJoin::all_ms, kLandscapeMsMax, 1e3);
  add("received", "MB", &HorizonJoin::bytes, kLandscapeBytesMax, 1e6);
}

}  // namespace

Done measure_horizon(Testbed& testbed, NetFindings& findings) {
  const FarViews views = views_of(testbed.options());
  const auto into = std::back_inserter(findings.tables);
  fmt::format_to(
      into,
      "\n### Horizon\n\nFirst joins of a new world, view radius {} chunks; medians "
      "of {}. ms from the start of the connection. *coarse*: all tiles of the highest level "
      "are here. *complete*: all tiles are here and meshed. The memory is that of tiles and "
      "their stand-ins, without meshes.\n\n"
      "| world | link | sees, voxels | near view 80 %, ms | coarse, ms | complete, ms | tiles | "
      "KB received | MB in the client |\n|---|---|---|---|---|---|---|---|---|\n",
      views.radius, testbed.options().repetitions);
  for (const test::LinkProfile& profile : testbed.profiles()) {
    const char* link = name_of(profile.passes_all() ? LinkKind::loopback : testbed.kind());
    std::vector<HorizonView> all;
    for (const unsigned levels : views.levels) all.push_back({"terrain", levels});
    all.push_back({"landscape", views.levels[kLandscapeView]});
    for (const HorizonView& view : all) {
      const unsigned levels = view.levels;
      const unsigned reach = views.reach(levels);
      const bool is_landscape = &view == &all.back();
      const auto joins = horizons_of(testbed, profile, view);
      if (!joins)
        return failure(fmt::format("horizon, {}, {}, {} levels: {}", view.generator, profile.name,
                                   levels, joins.error()));
      const auto middle = [&](double HorizonJoin::* what) { return median_of(*joins, what); };
      fmt::format_to(into, "| {} | {} ({}) | {} | {} |", view.generator, profile.name, link, reach,
                     number_text(middle(&HorizonJoin::near_ms)));
      if (levels == 0) {
        fmt::format_to(into, " – | – | – |");
      } else {
        fmt::format_to(into, " {} | {} | {} |", number_text(middle(&HorizonJoin::coarse_ms)),
                       number_text(middle(&HorizonJoin::all_ms)),
                       number_text(middle(&HorizonJoin::tiles)));
      }
      fmt::format_to(into, " {} | {} |\n", number_text(middle(&HorizonJoin::bytes) / 1e3),
                     number_text(middle(&HorizonJoin::memory_mb)));
      const std::string sees =
          is_landscape ? fmt::format("landscape, sees {}", reach) : fmt::format("sees {}", reach);
      const auto figure = [&](const char* what, double value) {
        findings.figures.push_back({"horizon", std::string(profile.name), link, sees, what, value});
      };
      figure("near_ms", middle(&HorizonJoin::near_ms));
      figure("bytes", middle(&HorizonJoin::bytes));
      if (levels > 0) {
        figure("coarse_ms", middle(&HorizonJoin::coarse_ms));
        figure("all_ms", middle(&HorizonJoin::all_ms));
        if (profile.name == "broadband" && is_landscape && !testbed.options().quick) {
          add_landscape_targets(*joins, findings);
        } else if (profile.name == "broadband" && !is_landscape) {
          add_targets(*joins, reach, findings);
        }
      }
      fmt::print(testbed.progress(), "horizon {} {} {}\n", view.generator, profile.name, reach);
      testbed.progress().flush();
    }
  }
  return {};
}

}  // namespace runstone::bench
