#include "bench/meshing/brush_case.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "bench/harness/clocks.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/meshing/visible_voxel.hpp"
#include "common/core/assert.hpp"
#include "common/core/hash.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/mesh/rdm/layer_mesher.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"

namespace runstone::bench {
namespace {

constexpr unsigned kBlock = 10;  // edits of one sort between those of the other

/// Times the steps of LayerMesher.
class StepClock {
 public:
  void operator()(rdm::LayerStep step) {
    const std::uint64_t now = now_ns();
    if (runs_) ns_[static_cast<std::size_t>(step_)] += static_cast<double>(now - since_);
    runs_ = true;
    step_ = step;
    since_ = now;
  }
  void stop() { (*this)(rdm::LayerStep::splice); }
  double ns(rdm::LayerStep step) const { return ns_[static_cast<std::size_t>(step)]; }

 private:
  std::array<double, 4> ns_{};
  rdm::LayerStep step_{};
  std::uint64_t since_ = 0;
  bool runs_ = false;
};

double median_or_0(const std::vector<double>& samples) {
  return samples.empty() ? 0 : median(samples);
}

/// The chunk of a volume with its mesh, before and after an edit.
class BrushedChunk {
 public:
  BrushedChunk(const Volume& volume, const VisibilityTable& visibility, bool alone)
      : before_(volume.scene.chunk),
        digest_(digest_of(before_)),
        neighbours_(alone ? MeshNeighbours{} : volume.scene.pointers()),
        visibility_(visibility) {
    mesh_rdm(before_, neighbours_, visibility_, scratch_, mesh_before_);
  }

  const ChunkMesh& mesh_before() const { return mesh_before_; }
  /// Returns the material of the chunk at a place of it.
  Material material(VoxelPos at, unsigned edge) const {
    return material_at(before_, local_of(at, static_cast<std::int32_t>(edge)));
  }

  /// Applies an edit to the unedited chunk. Returns the ns of the splice, or 0 if nothing changed.
  double apply(const EditDescriptor& edit) {
    chunk_ = before_;
    Digest digest = digest_;
    mesh_ = mesh_before_;
    const std::uint64_t start = now_ns();
    apply_stack(chunk_, digest, {}, std::span(&edit, 1), apply_scratch_, applied_);
    const std::uint64_t end = now_ns();
    return applied_.dirty.any() ? static_cast<double>(end - start) : 0;
  }
  double mesh_layers(bool& by_layers) {
    const std::uint64_t start = now_ns();
    by_layers =
        mesh_rdm_layers(chunk_, neighbours_, visibility_, applied_.dirty, {}, scratch_, mesh_);
    return static_cast<double>(now_ns() - start);
  }
  double mesh_whole() {
    const std::uint64_t start = now_ns();
    mesh_rdm(chunk_, neighbours_, visibility_, scratch_, whole_);
    return static_cast<double>(now_ns() - start);
  }
  /// Meshes the layers with a clock between the steps.
  StepClock mesh_steps() {
    StepClock clock;
    const MeshBorders borders{};
    const rdm::TouchedLayers touched(chunk_, neighbours_, applied_.dirty, {});
    rdm::LayerMesher(chunk_, neighbours_, borders, visibility_, scratch_.state(), mesh_, clock)
        .run(touched);
    clock.stop();
    return clock;
  }
  /// Aborts if the mesh of layers is not that of the chunk.
  void check() {
    mesh_rdm(chunk_, neighbours_, visibility_, scratch_, whole_);
    RUNSTONE_ASSERT(mesh_.opaque.quads == whole_.opaque.quads &&
                    mesh_.opaque.first == whole_.opaque.first &&
                    mesh_.transparent.quads == whole_.transparent.quads &&
                    mesh_.transparent.first == whole_.transparent.first);
  }

 private:
  const RunChunk& before_;
  const Digest digest_;
  const MeshNeighbours neighbours_;
  const VisibilityTable& visibility_;
  RunChunk chunk_;
  ApplyScratch apply_scratch_;
  ApplyResult applied_;
  RdmScratch scratch_;
  ChunkMesh mesh_before_, mesh_, whole_;
};

}  // namespace

BrushTiming measure_brush(const Volume& volume, const VisibilityTable& visibility,
                          const Brush& brush, bool alone, unsigned edits) {
  SplitMix64 rng(brush.size + 1);
  BrushedChunk chunk(volume, visibility, alone);
  if (chunk.mesh_before().empty()) return {};
  std::vector<double> apply, layers, whole, sweep, emit;
  unsigned by_layers = 0;
  // A block of each sort in turn: layers, the whole mesh, and the steps of layers. The bound ends
  // the loop where most edits change nothing.
  enum Sort { by_layer, by_chunk, by_step };
  const unsigned block = std::min(kBlock, edits);
  for (unsigned i = 0; i < 20 * edits && emit.size() < edits; ++i) {
    const VoxelPos at = draw_visible_voxel(chunk.mesh_before(), rng).at;
    const Material material = i % 2 == 0 ? kEmpty : chunk.material(at, volume.edge);
    const double apply_ns = chunk.apply(brush_edit(brush, at, material));
    if (apply_ns == 0) continue;
    apply.push_back(apply_ns);
    switch (static_cast<Sort>(i / block % 3)) {
      case by_layer: {
        bool is_by_layers = false;
        layers.push_back(chunk.mesh_layers(is_by_layers));
        by_layers += is_by_layers ? 1 : 0;
        chunk.check();
        break;
      }
      case by_chunk:
        whole.push_back(chunk.mesh_whole());
        break;
      case by_step: {
        const StepClock clock = chunk.mesh_steps();
        sweep.push_back(clock.ns(rdm::LayerStep::sweep));
        emit.push_back(clock.ns(rdm::LayerStep::open) + clock.ns(rdm::LayerStep::close) +
                       clock.ns(rdm::LayerStep::splice));
        chunk.check();
        break;
      }
    }
  }
  BrushTiming out;
  out.edits = static_cast<unsigned>(layers.size());
  if (out.edits == 0) return out;
  out.apply_ns = median(apply);
  out.layers_ns = median(layers);
  out.whole_ns = median_or_0(whole);
  out.layers_share = by_layers / static_cast<double>(out.edits);
  if (by_layers != 0) {
    out.sweep_ns = median_or_0(sweep);
    out.emit_ns = median_or_0(emit);
  }
  return out;
}

}  // namespace runstone::bench
