#include "bench/edits/edit_case.hpp"

#include <memory>
#include <span>

#include "bench/harness/clocks.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/meshing/visible_voxel.hpp"
#include "common/core/assert.hpp"
#include "common/core/hash.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"

namespace runstone::bench {
namespace {

struct Samples {
  std::vector<double> apply, remesh, chunk, all, full, border_all;
};

/// A chunk with its mesh, before and after edits of it or of a neighbour.
class MeshedChunk {
 public:
  MeshedChunk(const MeshNeighbours& neighbours, const VisibilityTable& visibility)
      : neighbours_(neighbours), visibility_(visibility) {}

  const ChunkMesh& mesh() const { return mesh_; }

  void mesh_all(const RunChunk& chunk) {
    mesh_rdm(chunk, neighbours_, visibility_, scratch_, mesh_);
  }
  void remesh(const RunChunk& chunk, const DirtyLayers& dirty,
              const std::array<DirtyLayers, kDirectionCount>& beyond) {
    mesh_rdm_layers(chunk, neighbours_, visibility_, dirty, beyond, scratch_, mesh_);
  }
  /// Aborts if the mesh is not that of `chunk`. Returns the ns of a full mesh.
  double check(const RunChunk& chunk) {
    const std::uint64_t start = now_ns();
    mesh_rdm(chunk, neighbours_, visibility_, scratch_, full_);
    const std::uint64_t meshed = now_ns();
    RUNSTONE_ASSERT(mesh_.opaque.quads == full_.opaque.quads &&
                    mesh_.transparent.quads == full_.transparent.quads);
    return static_cast<double>(meshed - start);
  }

 private:
  MeshNeighbours neighbours_;
  const VisibilityTable& visibility_;
  RdmScratch scratch_;
  ChunkMesh mesh_, full_;
};

/// The edited chunk, at the origin, and its six neighbours.
class EditedChunk {
 public:
  EditedChunk(const VoxelWorld& world, const Volume& volume)
      : world_(world),
        volume_(volume),
        chunk_(volume.scene.chunk),
        digest_(digest_of(chunk_)),
        meshed_(volume.scene.pointers(), *world.visibility) {
    meshed_.mesh_all(chunk_);
  }

  const RunChunk& chunk() const { return chunk_; }
  const ChunkMesh& mesh() const { return meshed_.mesh(); }

  void edit(VoxelPos at, Material material, Samples& samples) {
    const EditDescriptor edit{SetVoxel{at}, {}, material};
    const std::vector<Direction> touched = touched_by(at);
    const std::uint64_t start = now_ns();
    apply_stack(chunk_, digest_, {}, std::span(&edit, 1), apply_scratch_, result_);
    const std::uint64_t applied = now_ns();
    meshed_.remesh(chunk_, result_.dirty, {});
    const std::uint64_t meshed = now_ns();
    for (const Direction d : touched) {
      std::array<DirtyLayers, kDirectionCount> beyond{};
      beyond[static_cast<std::size_t>(opposite(d))] = result_.dirty;
      neighbour_at(d).meshed.remesh(neighbour_chunk(d), {}, beyond);
    }
    const std::uint64_t all = now_ns();
    samples.full.push_back(meshed_.check(chunk_));
    for (const Direction d : touched) neighbour_at(d).meshed.check(neighbour_chunk(d));
    samples.apply.push_back(static_cast<double>(applied - start));
    samples.remesh.push_back(static_cast<double>(meshed - applied));
    samples.chunk.push_back(static_cast<double>(meshed - start));
    samples.all.push_back(static_cast<double>((touched.empty() ? meshed : all) - start));
    if (!touched.empty()) samples.border_all.push_back(samples.all.back());
  }

 private:
  /// A neighbour. It is cut with its own neighbours when an edit first touches it.
  struct Neighbour {
    Neighbour(const VoxelWorld& world, VoxelPos origin, unsigned edge, Direction back,
              const RunChunk& edited)
        : volume(cut_volume(world, origin, edge)),
          meshed(pointers(back, edited), *world.visibility) {
      meshed.mesh_all(volume.scene.chunk);
    }
    MeshNeighbours pointers(Direction back, const RunChunk& edited) const {
      MeshNeighbours out = volume.scene.pointers();
      out[static_cast<std::size_t>(back)] = &edited;
      return out;
    }
    Volume volume;
    MeshedChunk meshed;
  };

  Neighbour& neighbour_at(Direction d) { return *neighbours_[static_cast<std::size_t>(d)]; }
  const RunChunk& neighbour_chunk(Direction d) { return neighbour_at(d).volume.scene.chunk; }

  /// Returns the neighbours that touch a voxel. Makes them ready to mesh first.
  std::vector<Direction> touched_by(VoxelPos at) {
    const auto side = static_cast<std::int32_t>(volume_.edge);
    std::vector<Direction> out;
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
      const auto d = static_cast<Direction>(i);
      const ChunkCoord step = neighbour({}, d);
      if (!volume_.scene.neighbours[i]) continue;
      if (box_of({}, side).contains({at.x + step.x, at.y + step.y, at.z + step.z})) continue;
      out.push_back(d);
      if (neighbours_[i]) continue;
      const VoxelPos& low = volume_.origin;
      neighbours_[i] = std::make_unique<Neighbour>(
          world_, VoxelPos{low.x + step.x * side, low.y + step.y * side, low.z + step.z * side},
          volume_.edge, opposite(d), chunk_);
    }
    return out;
  }

  const VoxelWorld& world_;
  const Volume& volume_;
  RunChunk chunk_;
  Digest digest_;
  ApplyScratch apply_scratch_;
  ApplyResult result_;
  MeshedChunk meshed_;
  std::array<std::unique_ptr<Neighbour>, kDirectionCount> neighbours_;
};

}  // namespace

EditTiming measure_edits(const VoxelWorld& world, const std::vector<Volume>& volumes,
                         unsigned per_volume, std::uint64_t seed) {
  SplitMix64 rng(seed);
  Samples samples;
  for (const Volume& volume : volumes) {
    EditedChunk edited(world, volume);
    if (edited.mesh().empty()) continue;
    const VoxelBox inside = box_of({}, static_cast<std::int32_t>(volume.edge));
    // The times that do not count: the first edit of a chunk, and the edits that take one back,
    // whose branches the processor has learned.
    Samples left_out;
    for (unsigned i = 0; i <= per_volume; ++i) {
      const VisibleVoxel visible = draw_visible_voxel(edited.mesh(), rng);
      const auto local = [&](VoxelPos at) {
        return local_of(at, static_cast<std::int32_t>(volume.edge));
      };
      const Material solid = material_at(edited.chunk(), local(visible.at));
      const ChunkCoord step = neighbour({}, visible.direction);
      const VoxelPos before = {visible.at.x + step.x, visible.at.y + step.y, visible.at.z + step.z};
      const bool place = rng.below(2) == 0 && inside.contains(before);
      const VoxelPos at = place ? before : visible.at;
      const Material old = material_at(edited.chunk(), local(at));
      edited.edit(at, place ? solid : kEmpty, i == 0 ? left_out : samples);
      edited.edit(at, old, left_out);
    }
  }
  if (samples.all.empty()) return {};
  return {samples.all.size(),    samples.border_all.size(),
          median(samples.apply), median(samples.remesh),
          median(samples.chunk), median(samples.all),
          median(samples.full),  samples.border_all.empty() ? 0 : median(samples.border_all)};
}

}  // namespace runstone::bench
