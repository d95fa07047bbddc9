// Veil: replaces the materials of voxels that nobody can see, so that the runs of a chunk are long
// and its bytes do not reveal the hidden voxels.
//
// A material *covers* if `covers` says opaque (for chunks: veil_visibilities() in
// common/materials). A voxel is *enclosed* if it covers and its six neighbours cover. The veil
// replaces enclosed voxels and no others, by materials that cover. So no drawn face, ray or
// collision changes, and light spreads as before. docs/veil.md describes the one exception, lamps
// inside of walls.
//
// The rule: the enclosed voxels between two voxels that keep their material, in index order, show
//   1. the material of the voxel before them, if it covers;
//   2. otherwise the material of the voxel behind them, if it covers;
//   3. otherwise the filler, a material that does not depend on the chunk.
// The result depends on the voxels that are not enclosed, and on nothing else. No other choice of
// covering materials for the enclosed voxels needs fewer runs in this axis order: a stretch of
// enclosed voxels adds a run only between two voxels that do not cover.
#pragma once
#include <array>
#include <memory>
#include <optional>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/veil/veil_borders.hpp"

namespace runstone {

/// The axis order in which chunks are veiled. Each holder of a chunk chooses its own order, so the
/// rule needs one order for all holders.
inline constexpr AxisOrder kVeilOrder = AxisOrder::zxy;

/// The buffers that calls reuse. A scratch belongs to one thread, and callers do not use its
/// contents.
class VeilScratch {
 public:
  VeilScratch();
  ~VeilScratch();
  VeilScratch(VeilScratch&&) noexcept;
  VeilScratch& operator=(VeilScratch&&) noexcept;
  struct State;
  State& state() { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

/// The visibilities, which say which materials cover, and the material that enclosed voxels show if
/// the chunk gives none. The table must live as long as this object.
struct VeilMaterials {
  const VisibilityTable& covers;
  Material filler;
};

/// Returns the usual filler: the lowest id that covers.
Material veil_filler(const VisibilityTable& covers);

/// Returns the chunk with its veil, in its own axis order, or nullopt if the veil changes no voxel.
/// The result never has more runs than the chunk. The veil of a veiled chunk changes nothing.
/// Requires a valid chunk of any extent, its borders, and a filler that covers unless all sides are
/// open. Thread: any, with one scratch each. In a steady state only the result allocates. Cost:
/// O(lines + runs).
std::optional<RunChunk> veiled(const RunChunk& chunk, const VeilBorders& borders,
                               const VeilMaterials& materials, VeilScratch& scratch);

/// Returns the veil of a chunk among its neighbours, in the axis order kVeilOrder. The voxels of
/// the result do not depend on the axis orders of the chunk and its neighbours. A missing neighbour
/// is null and counts as closed. Requires valid chunks whose sides are equal where they touch.
/// Cost: O(lines + runs), plus the cost of reorder().
RunChunk veil_of(const RunChunk& chunk,
                 const std::array<const RunChunk*, kDirectionCount>& neighbours,
                 const VeilMaterials& materials, VeilScratch& scratch);

}  // namespace runstone
