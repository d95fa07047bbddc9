#include "client/schedule/mesh_planner.hpp"

namespace runstone {
namespace {

ChunkKey beside(const ChunkKey& key, Direction d) { return {key.lod, neighbour(key.at, d)}; }

std::int64_t distance_squared(ChunkCoord a, ChunkCoord b) {
  const std::int64_t dx = std::int64_t{a.x} - b.x;
  const std::int64_t dy = std::int64_t{a.y} - b.y;
  const std::int64_t dz = std::int64_t{a.z} - b.z;
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace

void MeshPlanner::take(std::span<const ChunkNews> news) {
  for (const ChunkNews& chunk : news) {
    if (chunk.removed) {
      if (const auto it = states_.find(chunk.key); it != states_.end()) {
        if (it->second.rank) ready_.erase(*it->second.rank);
        if (it->second.dirty) --dirty_;
        states_.erase(it);
      }
      place_neighbours(chunk.key);
      continue;
    }
    mark(chunk.key, states_[chunk.key], !chunk.edits.empty());
    if (!chunk.whole) continue;
    for (int i = 0; i < kDirectionCount; ++i) {
      const auto d = static_cast<Direction>(i);
      const auto it = states_.find(beside(chunk.key, d));
      if (it == states_.end()) continue;
      const auto side = 1U << static_cast<unsigned>(opposite(d));
      if ((it->second.open_sides & side) != 0) {
        mark(it->first, it->second, false);
      } else {
        place(it->first, it->second);
      }
    }
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

bool MeshPlanner::ready(const ChunkKey& key) const {
  if (!replica_.shown(key)) return false;
  for (int i = 0; i < kDirectionCount; ++i) {
    const ChunkKey next = beside(key, static_cast<Direction>(i));
    const bool will_come =
        replica_.view() && replica_.view()->contains(next.at) && !replica_.unavailable(next);
    if (will_come && !replica_.shown(next)) return false;
  }
  return true;
}

void MeshPlanner::mark(const ChunkKey& key, State& state, bool edited) {
  if (!state.dirty) ++dirty_;
  state.dirty = true;
  state.edited = state.edited || edited;
  place(key, state);
}

/// Puts the chunk where it belongs in the order of jobs, or out of it.
void MeshPlanner::place(const ChunkKey& key, State& state) {
  if (state.rank) {
    ready_.erase(*state.rank);
    state.rank.reset();
  }
  if (!state.dirty || !ready(key)) return;
  state.rank = Rank{state.edited ? 0 : 1, distance_squared(key.at, eye_), key};
  ready_.insert(*state.rank);
}

void MeshPlanner::place_neighbours(const ChunkKey& key) {
  for (int i = 0; i < kDirectionCount; ++i) {
    const auto it = states_.find(beside(key, static_cast<Direction>(i)));
    if (it != states_.end()) place(it->first, it->second);
  }
}

std::optional<MeshJob> MeshPlanner::next() {
  while (!ready_.empty()) {
    const ChunkKey key = std::get<ChunkKey>(*ready_.begin());
    State& state = states_.at(key);
    ready_.erase(ready_.begin());
    state.rank.reset();
    if (!ready(key)) continue;  // a neighbour left since; its return places the chunk again
    MeshJob job;
    job.key = key;
    job.number = ++jobs_;
    job.serial = replica_.shown_serial(key);
    job.chunk = replica_.shown(key);
    state.open_sides = 0;
    for (std::size_t i = 0; i < job.neighbours.size(); ++i) {
      job.neighbours[i] = replica_.shown(beside(key, static_cast<Direction>(i)));
      if (!job.neighbours[i]) state.open_sides = static_cast<std::uint8_t>(state.open_sides | 1U << i);
    }
    if (state.job == 0) ++chunks_;
    state.job = job.number;
    state.dirty = false;
    state.edited = false;
    --dirty_;
    return job;
  }
  return std::nullopt;
}

bool MeshPlanner::accept(const ChunkKey& key, std::uint64_t number) {
  const auto it = states_.find(key);
  if (it == states_.end() || number <= it->second.drawn) return false;
  it->second.drawn = number;
  return true;
}

}  // namespace runstone
