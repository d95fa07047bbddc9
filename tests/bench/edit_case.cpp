#include "tests/bench/edit_case.hpp"

#include "common/core/assert.hpp"
#include "common/core/hash.hpp"
#include "common/edits/edit_stack.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "tests/bench/contestant.hpp"
#include "tests/bench/statistics.hpp"

namespace runstone::bench {
namespace {

struct Samples {
  std::vector<double> apply, remesh, both, full;
};

/// One chunk that is edited, at the origin.
class EditedChunk {
 public:
  EditedChunk(const Volume& volume, const VisibilityTable& visibility)
      : chunk_(volume.scene.chunk),
        digest_(digest_of(chunk_)),
        neighbours_(volume.scene.pointers()),
        visibility_(visibility) {
    mesh_rdm(chunk_, neighbours_, visibility_, scratch_, mesh_);
  }

  const RunChunk& chunk() const { return chunk_; }
  const ChunkMesh& mesh() const { return mesh_; }

  void edit(VoxelPos at, Material material, Samples& samples) {
    const EditDescriptor edit{SetVoxel{at}, {}, material};
    const std::uint64_t start = now_ns();
    apply_stack(chunk_, digest_, {}, std::span(&edit, 1), apply_scratch_, result_);
    const std::uint64_t applied = now_ns();
    mesh_rdm_layers(chunk_, neighbours_, visibility_, result_.dirty, {}, scratch_, mesh_);
    const std::uint64_t meshed = now_ns();
    mesh_rdm(chunk_, neighbours_, visibility_, scratch_, full_);
    const std::uint64_t again = now_ns();
    RUNSTONE_ASSERT(mesh_.opaque.quads == full_.opaque.quads &&
                    mesh_.transparent.quads == full_.transparent.quads);
    samples.apply.push_back(static_cast<double>(applied - start));
    samples.remesh.push_back(static_cast<double>(meshed - applied));
    samples.both.push_back(static_cast<double>(meshed - start));
    samples.full.push_back(static_cast<double>(again - meshed));
  }

 private:
  RunChunk chunk_;
  Digest digest_;
  MeshNeighbours neighbours_;
  const VisibilityTable& visibility_;
  ApplyScratch apply_scratch_;
  ApplyResult result_;
  RdmScratch scratch_;
  ChunkMesh mesh_, full_;
};

/// A voxel with a face, by a random place of a random quad, and the direction it shows.
struct Shown {
  VoxelPos at;
  Direction direction;
};
Shown pick(const ChunkMesh& mesh, SplitMix64& rng) {
  const std::size_t opaque = mesh.opaque.quads.size();
  const std::size_t i = rng.below(static_cast<std::uint32_t>(mesh.quad_count()));
  const QuadFields q = unpack(i < opaque ? mesh.opaque.quads[i] : mesh.transparent.quads[i - opaque]);
  std::array<std::int32_t, 3> at = {q.x, q.y, q.z};
  const Axis axis = axis_of(q.direction);
  at[static_cast<std::size_t>(u_axis_of(axis))] += static_cast<std::int32_t>(rng.below(q.width));
  at[static_cast<std::size_t>(v_axis_of(axis))] += static_cast<std::int32_t>(rng.below(q.height));
  return {{at[0], at[1], at[2]}, q.direction};
}

}  // namespace

EditTiming measure_edits(const std::vector<Volume>& volumes, const VisibilityTable& visibility,
                         unsigned per_volume, std::uint64_t seed) {
  SplitMix64 rng(seed);
  Samples samples;
  for (const Volume& volume : volumes) {
    EditedChunk edited(volume, visibility);
    if (edited.mesh().empty()) continue;
    const VoxelBox inside = box_of({}, static_cast<std::int32_t>(volume.edge));
    Samples warm_up;
    for (unsigned i = 0; i <= per_volume; ++i) {
      const Shown shown = pick(edited.mesh(), rng);
      const auto local = [&](VoxelPos at) { return local_of(at, static_cast<std::int32_t>(volume.edge)); };
      const Material solid = material_at(edited.chunk(), local(shown.at));
      const ChunkCoord step = neighbour({}, shown.direction);
      const VoxelPos before = {shown.at.x + step.x, shown.at.y + step.y, shown.at.z + step.z};
      const bool place = rng.below(2) == 0 && inside.contains(before);
      const VoxelPos at = place ? before : shown.at;
      const Material old = material_at(edited.chunk(), local(at));
      Samples& to = i == 0 ? warm_up : samples;
      edited.edit(at, place ? solid : kEmpty, to);
      edited.edit(at, old, to);
    }
  }
  if (samples.both.empty()) return {};
  return {samples.both.size(), median(samples.apply), median(samples.remesh), median(samples.both),
          median(samples.full)};
}

}  // namespace runstone::bench
