#include "common/veil/veil.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/runs/reorder.hpp"
#include "common/veil/veil_scratch.hpp"

namespace runstone {
namespace {

/// Writes the veiled runs. Its input is the runs of the chunk, and of each run the first voxel that
/// keeps its material. All later voxels of the run show this material, too.
class VeilWriter {
 public:
  VeilWriter(RunSink& sink, const VeilMaterials& materials) : sink_(sink), materials_(materials) {}

  /// Voxel `at` keeps its material. All voxels between the run of the last kept voxel and `at` are
  /// enclosed.
  void keep(std::uint32_t at, Material material, std::uint32_t run_end) {
    // If the run before covers, it continues up to here.
    if (!covers_ && end_ < at) sink_.append(end_, covers(material) ? material : materials_.filler);
    sink_.append(at, material);
    covers_ = covers(material);
    end_ = run_end;
  }
  /// Ends the runs. All voxels behind the run of the last kept voxel are enclosed.
  void finish(std::uint32_t volume) {
    if (!covers_ && end_ < volume) sink_.append(end_, materials_.filler);
  }

 private:
  bool covers(Material material) const { return materials_.covers[material] == Visibility::opaque; }
  RunSink& sink_;
  const VeilMaterials& materials_;
  bool covers_ = false;    // of the last voxel that was kept
  std::uint32_t end_ = 0;  // of the run of that voxel
};

/// Returns the first voxel of [from, to) of a layer that is not enclosed, or `to` if all are.
template <class Row>
std::uint32_t first_open(std::span<const Row> enclosed, std::uint32_t f, std::uint32_t from,
                         std::uint32_t to) {
  std::uint32_t line = from / f;
  Row open = ~enclosed[line] & bits_below<Row>(f) & ~bits_below<Row>(from - line * f);
  while (open == 0) {
    if (++line * f >= to) return to;
    open = ~enclosed[line] & bits_below<Row>(f);
  }
  return std::min(line * f + lowest_bit(open), to);
}

template <class Row, class Runs>
void veil_runs(Runs runs, const RunChunk& chunk, const VeilBorders& borders,
               const VeilMaterials& materials, EnclosedScratch<Row>& scratch, RunSink& sink) {
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  EnclosedLayers<Row, Runs> layers(runs, e, borders, materials.covers, scratch, 0);
  VeilWriter writer(sink, materials);
  std::size_t run = 0;
  bool is_kept = false;  // a voxel of the run
  for (std::uint32_t s = 0; s < e.s; ++s) {
    const std::span<const Row> enclosed = layers.next();
    const std::uint32_t first = s * e.layer(), end = first + e.layer();
    for (std::uint32_t at = first; at < end;) {
      const std::uint32_t run_end = runs.end(run), stop = std::min(run_end, end);
      if (!is_kept) {
        const std::uint32_t open = first + first_open(enclosed, e.f, at - first, stop - first);
        is_kept = open < stop;
        if (is_kept) writer.keep(open, runs.material(run), run_end);
      }
      if (run_end == stop) {
        ++run;
        is_kept = false;
      }
      at = stop;
    }
  }
  writer.finish(e.volume());
}

}  // namespace

VeilScratch::VeilScratch() : state_(std::make_unique<State>()) {}
VeilScratch::~VeilScratch() = default;
VeilScratch::VeilScratch(VeilScratch&&) noexcept = default;
VeilScratch& VeilScratch::operator=(VeilScratch&&) noexcept = default;

Material veil_filler(const VisibilityTable& covers) {
  std::size_t id = 0;
  while (id + 1 < kMaterialCountMax && covers[static_cast<Material>(id)] != Visibility::opaque)
    ++id;
  return static_cast<Material>(id);
}

std::optional<RunChunk> veiled(const RunChunk& chunk, const VeilBorders& borders,
                               const VeilMaterials& materials, VeilScratch& scratch) {
  RUNSTONE_ASSERT(borders.extent() == chunk.extent && borders.order() == chunk.order);
  if (chunk.is_uniform() && materials.covers[chunk.runs.material(0)] != Visibility::opaque)
    return std::nullopt;
  VeilScratch::State& state = scratch.state();
  state.sink.clear();
  const bool is_changed = chunk.runs.visit([&](auto runs) {
    if (ordered(chunk.extent, chunk.order).f <= kRowBits<Row64>) {
      veil_runs(runs, chunk, borders, materials, state.narrow, state.sink);
    } else {
      veil_runs(runs, chunk, borders, materials, state.wide, state.sink);
    }
    return !state.sink.holds(runs);
  });
  if (!is_changed) return std::nullopt;
  return RunChunk{chunk.extent, chunk.order, state.sink.runs_of(chunk.volume())};
}

RunChunk veil_of(const RunChunk& chunk,
                 const std::array<const RunChunk*, kDirectionCount>& neighbours,
                 const VeilMaterials& materials, VeilScratch& scratch) {
  RunChunk turned = reorder(chunk, kVeilOrder);
  const VeilBorders borders(turned, neighbours, materials.covers, MissingSide::closed);
  auto out = veiled(turned, borders, materials, scratch);
  return out ? *std::move(out) : turned;
}

}  // namespace runstone
