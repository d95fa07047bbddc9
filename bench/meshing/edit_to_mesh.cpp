#include "bench/meshing/edit_to_mesh.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/harness/statistics.hpp"
#include "bench/harness/target_json.hpp"
#include "bench/worlds/measured_worlds.hpp"

namespace runstone::bench {
namespace {

constexpr std::size_t kVolumesMax = 4;  // of a world, spread over it

/// Returns the median over volumes of one time.
double median_of(const std::vector<BrushTiming>& timings, double BrushTiming::* time) {
  std::vector<double> samples;
  for (const BrushTiming& timing : timings) samples.push_back(timing.*time);
  return median(samples);
}

std::vector<EditToMeshRow> measure_world(const MeasuredWorld& world, unsigned edge,
                                         unsigned edits) {
  std::vector<const Volume*> volumes;
  const std::size_t step = std::max<std::size_t>(1, world.volumes.size() / kVolumesMax);
  for (std::size_t v = 0; v < world.volumes.size() && volumes.size() < kVolumesMax; v += step)
    volumes.push_back(&world.volumes[v]);
  std::vector<EditToMeshRow> out;
  for (const bool alone : {false, true}) {
    for (const Brush& brush : brushes()) {
      std::vector<BrushTiming> timings;
      for (const Volume* const volume : volumes) {
        const BrushTiming timing = measure_brush(*volume, *world.visibility, brush, alone, edits);
        if (timing.edits != 0 && timing.whole_ns != 0) timings.push_back(timing);
      }
      if (timings.empty()) continue;
      EditToMeshRow row{world.name, brush.name(), edge, alone, timings.size(), {}};
      for (const BrushTiming& timing : timings) row.timing.edits += timing.edits;
      for (const auto time :
           {&BrushTiming::apply_ns, &BrushTiming::layers_ns, &BrushTiming::whole_ns,
            &BrushTiming::sweep_ns, &BrushTiming::emit_ns, &BrushTiming::layers_share}) {
        row.timing.*time = median_of(timings, time);
      }
      out.push_back(std::move(row));
    }
  }
  return out;
}

Target at_most(std::string what, double bar, double measured, const std::string& where) {
  return {std::move(what), fmt::format("at most {:.2f}x", bar),
          fmt::format("{:.2f}x: {}", measured, where),
          measured <= bar ? Verdict::met : Verdict::missed};
}

std::string name_of(const EditToMeshRow& row) {
  return fmt::format("{} {}{}, {}", row.world, row.edge, row.alone ? " alone" : "", row.brush);
}

/// Adds the target of the worst ratio of some rows.
template <class Wanted>
void judge(EditToMeshResult& result, const char* what, double bar, Wanted&& wanted) {
  const EditToMeshRow* worst = nullptr;
  for (const EditToMeshRow& row : result.rows) {
    if (wanted(row) && (worst == nullptr || row.ratio() > worst->ratio())) worst = &row;
  }
  if (worst != nullptr)
    result.targets.push_back(at_most(what, bar, worst->ratio(), name_of(*worst)));
}

}  // namespace

Result<EditToMeshResult, std::string> run_edit_to_mesh(const BenchOptions& options,
                                                       std::ostream& progress) {
  const auto worlds = MeasuredWorlds::open(options.worlds, options.luanti);
  if (!worlds) return failure(worlds.error());
  EditToMeshResult result;
  result.machine = this_machine();
  std::vector<std::string> skipped;
  worlds->measure_each(
      options.edges,
      [&](std::size_t, const MeasuredWorld& world, unsigned edge) {
        for (EditToMeshRow& row : measure_world(world, edge, options.repetitions))
          result.rows.push_back(std::move(row));
      },
      skipped, progress);
  judge(result, "layers / whole mesh, worst median of all rows", 1.1,
        [](const EditToMeshRow&) { return true; });
  const auto is_small_sphere = [](const EditToMeshRow& row) {
    return row.brush == "sphere r 1" || row.brush == "sphere r 2" || row.brush == "sphere r 3" ||
           row.brush == "sphere r 5";
  };
  judge(result, "layers / whole mesh, hills of edge 32, spheres of radius 1 to 5", 0.8,
        [&](const EditToMeshRow& row) {
          return row.world == "hills" && row.edge == 32 && is_small_sphere(row);
        });
  judge(result, "layers / whole mesh, caves of edge 64, spheres of radius 1 to 5", 0.8,
        [&](const EditToMeshRow& row) {
          return row.world == "caves" && row.edge == 64 && is_small_sphere(row);
        });
  return result;
}

void write_table(const EditToMeshResult& result, std::ostream& out) {
  fmt::print(out, "\nEdit to mesh: medians in µs\n\n");
  fmt::print(out,
             "| world | edge | neighbours | brush | runs spliced | layers | whole mesh | layers / "
             "whole | by layers | sweep | emit |\n"
             "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const EditToMeshRow& row : result.rows) {
    const BrushTiming& t = row.timing;
    fmt::print(out,
               "| {} | {} | {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.2f} | {:.0f} % | {:.1f} | "
               "{:.1f} |\n",
               row.world, row.edge, row.alone ? "no" : "yes", row.brush, t.apply_ns / 1e3,
               t.layers_ns / 1e3, t.whole_ns / 1e3, row.ratio(), 100 * t.layers_share,
               t.sweep_ns / 1e3, t.emit_ns / 1e3);
  }
  fmt::print(out, "\n");
  write_targets(result.targets, out);
}

void write_csv(const EditToMeshResult& result, std::ostream& out) {
  fmt::print(out,
             "world,edge,neighbours,brush,volumes,edits,apply_ns,layers_ns,whole_ns,sweep_ns,"
             "emit_ns,by_layers\n");
  for (const EditToMeshRow& row : result.rows) {
    const BrushTiming& t = row.timing;
    fmt::print(out, "{},{},{},{},{},{},{:.0f},{:.0f},{:.0f},{:.0f},{:.0f},{:.3f}\n", row.world,
               row.edge, row.alone ? 0 : 1, row.brush, row.volumes, t.edits, t.apply_ns,
               t.layers_ns, t.whole_ns, t.sweep_ns, t.emit_ns, t.layers_share);
  }
}

void write_json(const EditToMeshResult& result, std::ostream& out) {
  nlohmann::ordered_json json = {{"commit", result.machine.commit},
                                 {"cpu", result.machine.cpu},
                                 {"compiler", result.machine.compiler},
                                 {"rows", nlohmann::ordered_json::array()},
                                 {"bars", json_of(result.targets)}};
  for (const EditToMeshRow& row : result.rows) {
    const BrushTiming& t = row.timing;
    json["rows"].push_back({{"world", row.world},
                            {"edge", row.edge},
                            {"neighbours", !row.alone},
                            {"brush", row.brush},
                            {"volumes", row.volumes},
                            {"edits", t.edits},
                            {"apply_ns", t.apply_ns},
                            {"layers_ns", t.layers_ns},
                            {"whole_ns", t.whole_ns},
                            {"sweep_ns", t.sweep_ns},
                            {"emit_ns", t.emit_ns},
                            {"by_layers", t.layers_share}});
  }
  out << json.dump(1) << '\n';
}

}  // namespace runstone::bench
