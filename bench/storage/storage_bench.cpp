#include "bench/storage/storage_bench.hpp"

#include <fmt/format.h>

#include <bit>

#include "bench/harness/shuffled.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/storage/stores.hpp"
#include "bench/worlds/measured_worlds.hpp"

namespace runstone::bench {
namespace {

/// Measures all stores on one volume.
void measure_volume(const storage::StoreCase& input, unsigned repetitions, const StorageRow& shared,
                    std::vector<StorageRow>& rows) {
  const auto stores = storage::make_stores(input);
  std::vector<ShuffledCase> cases;
  for (const auto& store : stores) cases.push_back({std::string(store.name), store.repetition});
  const auto samples = run_shuffled(cases, repetitions);
  for (std::size_t i = 0; i < stores.size(); ++i) {
    const auto figure = [&](storage::StoreFigure which) {
      return median(samples[i][static_cast<std::size_t>(which)]);
    };
    StorageRow row = shared;
    row.store = stores[i].name;
    row.bytes = stores[i].bytes;
    row.build_ns = figure(storage::StoreFigure::build);
    row.read_ns = figure(storage::StoreFigure::read);
    row.walk_ns = figure(storage::StoreFigure::walk);
    row.edit_ns = figure(storage::StoreFigure::edit);
    row.brush_ns = figure(storage::StoreFigure::brush);
    rows.push_back(std::move(row));
  }
}

}  // namespace

Result<StorageResult, std::string> run_storage_bench(const BenchOptions& options,
                                                     std::ostream& progress) {
  for (const unsigned edge : options.edges) {
    if (!std::has_single_bit(edge)) {
      return failure(fmt::format("edge {}: trees and Morton codes want a power of two", edge));
    }
  }
  const auto worlds = MeasuredWorlds::open(options.worlds, options.luanti);
  if (!worlds) return failure(worlds.error());
  StorageResult result;
  result.machine = this_machine();
  result.repetitions = options.repetitions;
  result.morton_code = storage::morton_code_maker();
  const auto measure = [&](std::size_t, const MeasuredWorld& world, unsigned edge) {
    for (std::size_t v = 0; v < world.volumes.size(); ++v) {
      const RunChunk& chunk = world.volumes[v].scene.chunk;
      const storage::StoreCase input = storage::make_store_case(chunk, v);
      StorageRow shared;
      shared.world = world.name;
      shared.part = world.parts[v];
      shared.edge = edge;
      shared.runs = chunk.runs.size();
      shared.brush_voxels = input.brush_voxels;
      measure_volume(input, options.repetitions, shared, result.rows);
    }
  };
  worlds->measure_each(options.edges, measure, result.skipped, progress);
  return result;
}

}  // namespace runstone::bench
