#include "bench/edits/replay_case.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <span>

#include "bench/harness/clocks.hpp"
#include "common/core/assert.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/generate/generator.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/runs/chunk.hpp"
#include "common/runs/reorder.hpp"
#include "server/replay/replayer.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/support/edits/builder_session.hpp"

namespace runstone::bench {
namespace {

constexpr std::uint16_t kReplayEdge = 32;
constexpr std::uint64_t kSeed = 7;
constexpr std::size_t kGroup = 64;  // records in a transaction while the log is written

double per_second(std::size_t edits, std::uint64_t start_ns) {
  return static_cast<double>(edits) * 1e9 / static_cast<double>(now_ns() - start_ns);
}

/// Chunks of terrain during the edits, each with its mesh.
class Land {
 public:
  Land(const Generator& generator, const VisibilityTable& visibility)
      : generator_(generator), visibility_(visibility) {}

  /// Makes the chunk of an edit and its neighbours, and meshes the chunk if `meshed`.
  void prepare(VoxelPos at, bool meshed) {
    const ChunkCoord own = chunk_of(at, kReplayEdge);
    chunk(own);
    if (!meshed) return;
    mesh_if_new(own);
    for (const Direction d : kDirections) {
      const ChunkCoord beside = neighbour(own, d);
      if (sees(beside, at)) mesh_if_new(beside);
    }
  }
  void apply(const EditDescriptor& edit, VoxelPos at) {
    const ChunkCoord own = chunk_of(at, kReplayEdge);
    Held& held = *chunks_.find(own)->second;
    apply_stack(held.chunk.voxels, held.chunk.digest, origin_of(own, kReplayEdge),
                std::span(&edit, 1), scratch_, result_);
  }
  /// Meshes the layers that the last edit made dirty.
  void remesh(VoxelPos at) {
    if (!result_.changed) return;
    const ChunkCoord own = chunk_of(at, kReplayEdge);
    remesh_layers(*chunks_.find(own)->second, result_.dirty, {});
    for (const Direction d : kDirections) {
      const ChunkCoord beside = neighbour(own, d);
      if (!sees(beside, at)) continue;
      std::array<DirtyLayers, kDirectionCount> beyond{};
      beyond[static_cast<std::size_t>(opposite(d))] = result_.dirty;
      remesh_layers(*chunks_.find(beside)->second, {}, beyond);
    }
  }
  std::size_t chunks() const { return chunks_.size(); }
  void check() {
    for (const auto& [at, held] : chunks_)
      RUNSTONE_ASSERT(digest_of(held->chunk.voxels) == held->chunk.digest);
  }

 private:
  struct Held {
    Chunk chunk;
    MeshNeighbours neighbours{};
    ChunkMesh mesh;
    bool is_meshed = false;
  };

  static constexpr std::array<Direction, kDirectionCount> kDirections = {
      Direction::neg_x, Direction::pos_x, Direction::neg_y,
      Direction::pos_y, Direction::neg_z, Direction::pos_z};

  /// Returns true if a voxel lies in the layer that touches the chunk.
  static bool sees(ChunkCoord beside, VoxelPos at) {
    VoxelBox around = box_of(beside, kReplayEdge);
    around.min = {around.min.x - 1, around.min.y - 1, around.min.z - 1};
    around.max = {around.max.x + 1, around.max.y + 1, around.max.z + 1};
    return around.contains(at);
  }
  Held& chunk(ChunkCoord at) {
    auto& held = chunks_[at];
    if (held) return *held;
    held = std::make_unique<Held>();
    held->chunk.voxels = in_cheapest_order(
        generator_.generate(origin_of(at, kReplayEdge), Extent::cube(kReplayEdge)));
    held->chunk.digest = digest_of(held->chunk.voxels);
    return *held;
  }
  void mesh_if_new(ChunkCoord at) {
    Held& held = chunk(at);
    if (held.is_meshed) return;
    for (const Direction d : kDirections) {
      held.neighbours[static_cast<std::size_t>(d)] = &chunk(neighbour(at, d)).chunk.voxels;
    }
    mesh_rdm(held.chunk.voxels, held.neighbours, visibility_, rdm_, held.mesh);
    held.is_meshed = true;
  }
  void remesh_layers(Held& held, const DirtyLayers& dirty,
                     const std::array<DirtyLayers, kDirectionCount>& beyond) {
    mesh_rdm_layers(held.chunk.voxels, held.neighbours, visibility_, dirty, beyond, rdm_,
                    held.mesh);
  }

  const Generator& generator_;
  const VisibilityTable& visibility_;
  std::map<ChunkCoord, std::unique_ptr<Held>> chunks_;
  ApplyScratch scratch_;
  ApplyResult result_;
  RdmScratch rdm_;
};

Result<std::unique_ptr<Store>, std::string> write_world(const std::string& folder,
                                                        const WorldMeta& meta,
                                                        const std::vector<EditRecord>& records) {
  auto store = create_sqlite_world(folder, meta, {"", false});
  if (!store) return failure(store.error().message());
  const auto raised = (*store)->raise_epoch();
  if (!raised) return failure(raised.error().message());
  for (std::size_t first = 0; first < records.size(); first += kGroup) {
    const std::size_t count = std::min(kGroup, records.size() - first);
    const auto written = (*store)->append({}, std::span(records).subspan(first, count));
    if (!written) return failure(written.error().message());
  }
  return *std::move(store);
}

}  // namespace

Result<ReplayTiming, std::string> time_replay(std::size_t edits, unsigned repetitions,
                                              const std::string& folder) {
  WorldMeta meta;
  meta.chunk_edge = kReplayEdge;
  meta.generator = {"terrain", 1, kSeed, ""};
  meta.materials = default_material_table();
  const auto generator = make_generator(meta.generator, meta.materials);
  if (!generator) return failure(generator.error().what);
  const VisibilityTable visibility(visibilities(meta.materials));

  test::BuilderSession session(kSeed);
  std::vector<EditRecord> records;
  while (records.size() < edits) records.push_back(session.next());
  const auto store = write_world(folder, meta, records);
  if (!store) return failure(store.error());

  ReplayTiming timing;
  timing.edits = edits;
  const auto at_of = [](const EditRecord& record) {
    return std::get<SetVoxel>(record.edit.shape).at;
  };
  for (unsigned i = 0; i < repetitions; ++i) {
    Replayer replayer(**store, **generator);
    const std::uint64_t start = now_ns();
    const auto report = replayer.run(kSequenceMax);
    if (!report) return failure(report.error().message());
    timing.from_log.push_back(per_second(edits, start));
    timing.chunks = report->digests.size();

    Land bare(**generator, visibility);
    for (const EditRecord& record : records) bare.prepare(at_of(record), false);
    const std::uint64_t second = now_ns();
    for (const EditRecord& record : records) bare.apply(record.edit, at_of(record));
    timing.apply.push_back(per_second(edits, second));
    bare.check();

    Land meshed(**generator, visibility);
    for (const EditRecord& record : records) meshed.prepare(at_of(record), true);
    const std::uint64_t third = now_ns();
    for (const EditRecord& record : records) {
      meshed.apply(record.edit, at_of(record));
      meshed.remesh(at_of(record));
    }
    timing.remesh.push_back(per_second(edits, third));
    meshed.check();
  }
  return timing;
}

}  // namespace runstone::bench
