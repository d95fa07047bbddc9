#include "client/schedule/mesh_planner.hpp"

#include <algorithm>
#include <utility>

#include "common/core/chunk_distance.hpp"
#include "common/mesh/shapes/shape_mesher.hpp"
#include "common/runs/material_scan.hpp"

namespace runstone {
namespace {

ChunkKey beside(const ChunkKey& key, Direction d) { return {key.lod, neighbour(key.at, d)}; }

}  // namespace

std::size_t mesh_bytes(const MeshPtr& mesh) {
  if (!mesh || mesh->empty()) return 0;
  return sizeof(ChunkMesh) +
         (mesh->opaque.quads.capacity() + mesh->transparent.quads.capacity() +
          mesh->shapes.opaque.capacity() + mesh->shapes.transparent.capacity()) *
             sizeof(Quad);
}

std::size_t mesh_bytes_about(const MeshJob& job, const ShapeTable& shapes) {
  const RunList& runs = job.chunk->runs;
  std::size_t quads = 3 * runs.size();
  if (!shapes.empty()) {
    std::size_t of_shapes = 0;
    runs.visit([&](auto view) {
      std::size_t begin = 0;
      for (std::size_t i = 0; i < view.size() && of_shapes < kShapeQuadsMax; ++i) {
        const std::size_t end = view.end(i);
        const Material material = view.material(i);
        if (!shapes.is_cube(material))
          of_shapes += (end - begin) * shapes[material].faces.faces().size();
        begin = end;
      }
    });
    quads += std::min(of_shapes, kShapeQuadsMax);
  }
  return sizeof(ChunkMesh) + quads * sizeof(Quad);
}

template <class Act>
void MeshPlanner::for_each_beside(const ChunkKey& key, Act act) {
  for (int i = 0; i < kDirectionCount; ++i) {
    const auto it = states_.find(beside(key, static_cast<Direction>(i)));
    if (it != states_.end()) act(it->first, it->second);
  }
}

void MeshPlanner::take(std::span<const ChunkChange> changes) {
  for (const ChunkChange& chunk : changes) {
    if (chunk.removed) {
      if (const auto it = states_.find(chunk.key); it != states_.end()) {
        if (it->second.rank) ready_.erase(*it->second.rank);
        if (it->second.dirty) --dirty_;
        keep(it->second, nullptr);
        borders_.erase(chunk.key);
        states_.erase(it);
      }
      // The neighbours show their faces towards it from now on.
      for_each_beside(chunk.key, [this](const ChunkKey& key, State& state) {
        if (state.counted) {
          mark_whole(key, state);
        } else {
          place(key, state);
        }
      });
      continue;
    }
    State& state = states_[chunk.key];
    state.serial = chunk.serial;
    state.changed |= chunk.layers;
    if (chunk.whole || chunk.layers.here.any()) borders_.erase(chunk.key);
    state.urgency = std::max(state.urgency, urgency_of(chunk));
    if (!chunk.whole) {
      mark(chunk.key, state);
      continue;
    }
    mark_whole(chunk.key, state);
    // The jobs of neighbours were made without this chunk, or with an older version of it.
    for_each_beside(chunk.key, [this](const ChunkKey& key, State& other) {
      if (other.counted) {
        mark_whole(key, other);
      } else {
        place(key, other);
      }
    });
  }
}

void MeshPlanner::view_changed() {
  for (auto& [key, state] : states_) place(key, state);
}

void MeshPlanner::set_eye(ChunkCoord eye) {
  if (eye == eye_) return;
  eye_ = eye;
  view_changed();
}

bool MeshPlanner::ready(const ChunkKey& key, const State& state) const {
  if (!replica_.shown(key)) return false;
  if (state.urgency != Urgency::terrain) return true;
  for (int i = 0; i < kDirectionCount; ++i) {
    const ChunkKey next = beside(key, static_cast<Direction>(i));
    if (replica_.is_expected(next) && !replica_.shown(next)) return false;
  }
  return true;
}

void MeshPlanner::mark(const ChunkKey& key, State& state) {
  if (!state.dirty) ++dirty_;
  state.dirty = true;
  place(key, state);
}

/// Marks the chunk to be meshed as a whole. Makes its open job void.
void MeshPlanner::mark_whole(const ChunkKey& key, State& state) {
  keep(state, nullptr);
  if (std::exchange(state.job, 0) != 0)
    state.urgency = std::max(state.urgency, state.urgency_in_job);
  mark(key, state);
}

/// Inserts the chunk at its place in the order of jobs, or removes it.
void MeshPlanner::place(const ChunkKey& key, State& state) {
  if (state.rank) {
    ready_.erase(*state.rank);
    state.rank.reset();
  }
  if (!state.dirty || state.job != 0 || !ready(key, state)) return;
  state.rank =
      Rank{state.mesh                          ? 0
           : state.urgency != Urgency::terrain ? 1
                                               : 2,
           state.urgency == Urgency::local_edit ? 0 : 1, distance_squared(key.at, eye_), key};
  ready_.insert(*state.rank);
}

std::optional<MeshJob> MeshPlanner::next(JobSize size) {
  while (!ready_.empty()) {
    const ChunkKey key = std::get<ChunkKey>(*ready_.begin());
    State& state = states_.at(key);
    if (size == JobSize::layers && !state.mesh) return std::nullopt;
    ready_.erase(ready_.begin());
    state.rank.reset();
    // A neighbour has left since. When it returns, the chunk is placed again.
    if (!ready(key, state)) continue;
    MeshJob job;
    job.key = key;
    job.serial = replica_.shown_serial(key);
    job.chunk = replica_.shown(key);
    std::uint8_t open_sides = 0;
    for (std::size_t i = 0; i < job.neighbours.size(); ++i) {
      const ChunkKey next = beside(key, static_cast<Direction>(i));
      job.neighbours[i] = replica_.shown(next);
      job.borders[i] = borders_.find(next, job.neighbours[i]);
      if (!job.neighbours[i]) open_sides = static_cast<std::uint8_t>(open_sides | 1U << i);
    }
    // The kept mesh and the changed layers give the present mesh if take() has got all changes.
    const bool is_incremental = state.mesh && state.serial == job.serial &&
                                state.order == job.chunk->order && state.open_sides == open_sides;
    MeshPtr before = keep(state, nullptr);
    if (is_incremental) {
      job.before = std::move(before);
      job.changed = state.changed;
    }
    if (size == JobSize::layers && !is_incremental) {
      place(key, state);  // among the chunks to be meshed as a whole
      continue;
    }
    job.number = ++jobs_;
    state.changed = {};
    state.order = job.chunk->order;
    state.open_sides = open_sides;
    state.job = job.number;
    if (!std::exchange(state.counted, true)) ++chunks_;
    state.dirty = false;
    state.urgency_in_job = job.urgency = std::exchange(state.urgency, Urgency::terrain);
    --dirty_;
    return job;
  }
  return std::nullopt;
}

bool MeshPlanner::finish(const ChunkKey& key, std::uint64_t number, MeshPtr mesh,
                         const ShownPtr& runs, BordersPtr borders) {
  const auto it = states_.find(key);
  if (it == states_.end() || number != it->second.job) return false;
  keep(it->second, std::move(mesh));
  if (borders && replica_.shown(key) == runs) borders_.keep(key, runs, std::move(borders));
  it->second.job = 0;
  place(key, it->second);
  return true;
}

void MeshPlanner::forget_meshes() {
  borders_.clear();
  for (auto& [key, state] : states_) mark_whole(key, state);
}

void MeshPlanner::mesh_again_from(Material first) {
  for (auto& [key, state] : states_) {
    const ShownPtr shown = replica_.shown(key);
    if (!shown || !has_material_from(*shown, first)) continue;
    borders_.erase(key);
    mark_whole(key, state);
    for_each_beside(key,
                    [this](const ChunkKey& other, State& beside) { mark_whole(other, beside); });
  }
}

MeshPtr MeshPlanner::keep(State& state, MeshPtr mesh) {
  kept_bytes_ += mesh_bytes(mesh);
  kept_bytes_ -= mesh_bytes(state.mesh);
  return std::exchange(state.mesh, std::move(mesh));
}

}  // namespace runstone
