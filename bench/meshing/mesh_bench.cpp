#include "bench/meshing/mesh_bench.hpp"

#include <algorithm>

#include "bench/edits/edit_case.hpp"
#include "bench/meshing/mesh_targets.hpp"
#include "bench/meshing/order_name.hpp"
#include "bench/worlds/measured_worlds.hpp"
#include "common/runs/reorder.hpp"

namespace runstone::bench {
namespace {

struct RankedOrder {
  AxisOrder order;
  std::string rank;
};

/// Returns the wanted orders, each once.
std::vector<RankedOrder> orders_of(const RunChunk& chunk, const std::vector<std::string>& wanted) {
  const auto is_wanted = [&](const char* what) {
    return std::find(wanted.begin(), wanted.end(), what) != wanted.end();
  };
  const auto runs = runs_per_order(chunk);
  const auto fewest = std::min_element(runs.begin(), runs.end()) - runs.begin();
  const auto most = std::max_element(runs.begin(), runs.end()) - runs.begin();
  std::vector<RankedOrder> out;
  for (const AxisOrder order : kAxisOrders) {
    const auto i = static_cast<std::ptrdiff_t>(order);
    const char* rank = i == fewest ? "best" : i == most ? "worst" : "between";
    if (is_wanted("all") || is_wanted(rank)) out.push_back({order, rank});
  }
  return out;
}

std::vector<std::string_view> meshers_of(const BenchOptions& options) {
  const auto all = mesher_case_names();
  std::vector<std::string_view> out(all.begin(), all.end());
  if (!options.meshers.empty()) {
    std::erase_if(out, [&](std::string_view name) {
      return std::find(options.meshers.begin(), options.meshers.end(), name) ==
             options.meshers.end();
    });
  }
  return out;
}

/// Measures all meshers on one volume in one order.
void measure_volume(const BenchOptions& options, const Volume& volume,
                    const VisibilityTable& visibility, const MeshRow& shared, MeshResult& result) {
  const std::size_t first = result.rows.size();
  std::vector<MesherCase> mesher_cases;
  const auto skip = [&](std::string_view mesher, const char* why) {
    MeshRow row = shared;
    row.mesher = mesher;
    result.skipped.push_back(row.cell() + ": " + why);
  };
  for (const std::string_view name : meshers_of(options)) {
    if (auto mesher_case = make_mesher_case(name, volume, visibility)) {
      mesher_cases.push_back(std::move(*mesher_case));
    } else {
      skip(name, "sides above 64");
    }
  }
  const auto timings = measure_cell(mesher_cases, options.repetitions);
  for (std::size_t i = 0; i < mesher_cases.size(); ++i) {
    if (!timings[i]) {
      skip(mesher_cases[i].name, "would take longer than 5 s");
      continue;
    }
    MeshRow row = shared;
    row.mesher = mesher_cases[i].name;
    row.timing = *timings[i];
    result.rows.push_back(std::move(row));
  }
  const auto median_of = [&](std::string_view mesher) -> std::optional<double> {
    for (std::size_t i = first; i < result.rows.size(); ++i) {
      if (result.rows[i].mesher == mesher) return result.rows[i].timing.median_ns;
    }
    return std::nullopt;
  };
  const auto decode = median_of("decode_binary"), mask = median_of("mask_binary");
  const bool has_faces =
      std::all_of(result.rows.begin() + static_cast<std::ptrdiff_t>(first), result.rows.end(),
                  [](const MeshRow& row) { return row.timing.mesh.triangles != 0; });
  for (std::size_t i = first; i < result.rows.size(); ++i) {
    result.rows[i].has_faces = has_faces;
    const double ours = result.rows[i].timing.median_ns;
    if (decode) result.rows[i].against_decode = *decode / ours;
    if (mask) result.rows[i].against_mask = *mask / ours;
  }
}

}  // namespace

Result<MeshResult, std::string> run_mesh_bench(const BenchOptions& options,
                                               std::ostream& progress) {
  const auto worlds = MeasuredWorlds::open(options.worlds, options.luanti);
  if (!worlds) return failure(worlds.error());
  MeshResult result;
  result.machine = this_machine();
  result.repetitions = options.repetitions;
  EditTiming edits;
  const auto measure = [&](std::size_t number, const MeasuredWorld& world, unsigned edge) {
    for (std::size_t v = 0; v < world.volumes.size(); ++v) {
      if (!options.parts.empty() && std::find(options.parts.begin(), options.parts.end(),
                                              world.parts[v]) == options.parts.end()) {
        continue;
      }
      for (const RankedOrder& order : orders_of(world.volumes[v].scene.chunk, options.orders)) {
        Volume volume = world.volumes[v];
        volume.scene.chunk = reorder(volume.scene.chunk, order.order);
        MeshRow shared;
        shared.world = world.name;
        shared.part = world.parts[v];
        shared.edge = edge;
        shared.order = name_of(order.order);
        shared.rank = order.rank;
        shared.runs = volume.scene.chunk.runs.size();
        measure_volume(options, volume, *world.visibility, shared, result);
      }
    }
    if (world.name == "luanti" && edge == 32) {
      edits = measure_edits(*worlds->voxels(number), world.volumes, options.repetitions, 1);
    }
  };
  worlds->measure_each(options.edges, measure, result.skipped, progress);
  result.targets = mesh_targets(result.rows, edits);
  const bool has_town =
      options.worlds.empty() ||
      std::find(options.worlds.begin(), options.worlds.end(), "town") != options.worlds.end();
  if (has_town && std::find(options.edges.begin(), options.edges.end(), 32U) != options.edges.end())
    result.targets.push_back(
        shapes_target(measure_shapes(static_cast<unsigned>(options.repetitions))));
  return result;
}

}  // namespace runstone::bench
