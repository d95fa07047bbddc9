#include "bench/storage/stores.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>

#include "bench/harness/clocks.hpp"
#include "bench/storage/flat_array.hpp"
#include "bench/storage/interval_map.hpp"
#include "bench/storage/morton_array.hpp"
#include "bench/storage/palette_store.hpp"
#include "bench/storage/run_store.hpp"
#include "bench/storage/voxel_tree.hpp"

namespace runstone::bench::storage {
namespace {

constexpr std::array<std::string_view, 7> kNames = {"flat",         "morton", "palette", "runs",
                                                    "interval_map", "octree", "dag"};

// A block of calls that are timed together, or one call if it takes longer.
constexpr double kBlockNs = 50'000;
// The bytes of the stores that are built or painted together, and their number.
constexpr std::size_t kBatchBytes = 256 * 1024;
constexpr std::size_t kBatchMax = 16;

/// Returns the time that a call of the clock takes.
double clock_ns() {
  static const double cost = [] {
    std::uint64_t least = ~std::uint64_t{0};
    for (int i = 0; i < 200; ++i) {
      const std::uint64_t start = core_ns();
      least = std::min(least, core_ns() - start);
    }
    return static_cast<double>(least);
  }();
  return cost;
}

template <class Work>
double core_ns_of(Work&& work) {
  const std::uint64_t start = core_ns();
  work();
  // A call of the clock may take a little less than its fastest measured time, so no result is
  // below one.
  return std::max(static_cast<double>(core_ns() - start) - clock_ns(), 1.0);
}

/// Returns the time of a call of work that changes nothing: one call to warm up, then as many as
/// fill a block.
template <class Work>
double block_ns(Work&& work) {
  const double once = std::max(core_ns_of(work), 20.0);
  const auto calls = static_cast<std::uint64_t>(std::max(1.0, kBlockNs / once));
  return core_ns_of([&] {
           for (std::uint64_t i = 0; i < calls; ++i) work();
         }) /
         static_cast<double>(calls);
}

template <VoxelStore Store>
double read_ns(const Store& store, const StoreCase& input) {
  return block_ns([&] {
           for (const LocalPos at : input.reads) {
             const Material material = store.at(at);
             // Each material is used alone, because in a store of one material all reads have the
             // same result.
             benchmark::DoNotOptimize(material);
           }
           benchmark::ClobberMemory();
         }) /
         static_cast<double>(input.reads.size());
}

template <VoxelStore Store>
double walk_ns(const Store& store, const StoreCase& input) {
  return block_ns([&] {
           std::uint64_t sum = 0;
           store.walk([&](std::uint32_t count, Material material) {
             sum += std::uint64_t{count} * material;
           });
           benchmark::DoNotOptimize(sum);
           benchmark::ClobberMemory();
         }) /
         input.chunk.volume();
}

/// Works on a copy, so that the store keeps nothing from an edit, such as a grown palette.
template <VoxelStore Store>
double edit_ns(const Store& store, const StoreCase& input) {
  Store edited = store;
  return block_ns([&] {
           for (const PointEdit& edit : input.edits) {
             edited.set(edit.at, edit.now);
             // Otherwise an array would be written only the second time.
             benchmark::ClobberMemory();
             edited.set(edit.at, edit.before);
             benchmark::ClobberMemory();
           }
         }) /
         static_cast<double>(2 * input.edits.size());
}

/// Returns the size of a batch. Batches keep the calls of the clock few.
template <VoxelStore Store>
std::size_t batch_of(const Store& store) {
  return std::clamp<std::size_t>(kBatchBytes / store.byte_size(), 1, kBatchMax);
}

template <VoxelStore Store>
double build_ns(const Store& store, const StoreCase& input) {
  const std::size_t batch = batch_of(store);
  std::vector<Store> built;
  built.reserve(batch);
  built.emplace_back(input.chunk);  // to warm up
  built.clear();
  return core_ns_of([&] {
           for (std::size_t i = 0; i < batch; ++i) built.emplace_back(input.chunk);
         }) /
         static_cast<double>(batch);
}

/// Paints each brush on the original voxels.
template <VoxelStore Store>
double brush_ns(const Store& store, const StoreCase& input) {
  const std::size_t batch = batch_of(store);
  double sum = 0;
  for (const Brush& brush : input.brushes) {
    std::vector<Store> painted(batch, store);
    sum += core_ns_of([&] {
      for (Store& each : painted) each.paint(brush.ball, brush.material);
    });
  }
  return sum / static_cast<double>(batch * input.brushes.size());
}

template <VoxelStore Store>
MeasuredStore measured_store(std::string_view name, const StoreCase& input) {
  const auto store = std::make_shared<const Store>(input.chunk);
  return {name, store->byte_size(), [store, &input] {
            std::vector<double> out(kStoreFigureCount);
            const auto figure = [&](StoreFigure which) -> double& {
              return out[static_cast<std::size_t>(which)];
            };
            figure(StoreFigure::build) = build_ns(*store, input);
            figure(StoreFigure::read) = read_ns(*store, input);
            figure(StoreFigure::walk) = walk_ns(*store, input);
            figure(StoreFigure::edit) = edit_ns(*store, input);
            figure(StoreFigure::brush) = brush_ns(*store, input);
            return out;
          }};
}

}  // namespace

std::span<const std::string_view> store_names() { return kNames; }

std::vector<MeasuredStore> make_stores(const StoreCase& input) {
  std::vector<MeasuredStore> out;
  out.push_back(measured_store<FlatArray>(kNames[0], input));
  out.push_back(morton_by_pdep() ? measured_store<MortonArray<MortonByPdep>>(kNames[1], input)
                                 : measured_store<MortonArray<MortonByTable>>(kNames[1], input));
  out.push_back(measured_store<PaletteStore>(kNames[2], input));
  out.push_back(measured_store<RunStore>(kNames[3], input));
  out.push_back(measured_store<IntervalMap>(kNames[4], input));
  out.push_back(measured_store<SparseOctree>(kNames[5], input));
  out.push_back(measured_store<VoxelDag>(kNames[6], input));
  return out;
}

std::string_view morton_code_maker() { return morton_by_pdep() ? "pdep" : "table"; }

}  // namespace runstone::bench::storage
