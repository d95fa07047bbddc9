#include "client/api/chunk_reports.hpp"

namespace runstone {
namespace {

ChangeCause cause_of(Urgency urgency) {
  switch (urgency) {
    case Urgency::local_edit:
      return ChangeCause::own_edit;
    case Urgency::edit:
      return ChangeCause::others_edit;
    case Urgency::terrain:
      break;
  }
  return ChangeCause::terrain;
}

}  // namespace

void ChunkReports::take(std::span<const ChunkChange> changes, EventQueue& events) {
  planner_.take(changes);
  for (const ChunkChange& change : changes) {
    if (change.removed && reported_.erase(change.key.at) != 0)
      events.push(ChunkRemoved{change.key.at});
  }
}

std::optional<ChunkChanged> ChunkReports::next() {
  std::optional<MeshJob> job = planner_.next();
  if (!job) return std::nullopt;
  // The program meshes the source that it gets, so the planner does not wait for a result.
  static_cast<void>(planner_.finish(job->key, job->number, nullptr));
  reported_.insert(job->key.at);
  return ChunkChanged{{job->key.at, job->serial, std::move(job->chunk), std::move(job->neighbours)},
                      cause_of(job->urgency)};
}

std::optional<MeshSource> ChunkReports::source(ChunkCoord at) const {
  MeshSource out{at, replica_.shown_serial({0, at}), replica_.shown({0, at}), {}};
  if (!out.chunk) return std::nullopt;
  for (std::size_t i = 0; i < out.neighbours.size(); ++i)
    out.neighbours[i] = replica_.shown({0, neighbour(at, static_cast<Direction>(i))});
  return out;
}

}  // namespace runstone
