#include "server/history/moments.hpp"

#include <algorithm>
#include <utility>

#include "server/store/store.hpp"

namespace runstone {
StoreResult<std::shared_ptr<Moments::Kept>> Moments::find(Sequence at) {
  std::shared_ptr<Kept> moment;
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(kept_.begin(), kept_.end(),
                                    [at](const auto& kept) { return kept.first == at; });
    if (found != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, found);
    } else {
      kept_.emplace_front(at, std::make_shared<Kept>());
      if (kept_.size() > kept_max_) kept_.pop_back();  // its users share ownership
    }
    moment = kept_.front().second;
  }
  // If two threads want the moment, the second one waits here until the first one has opened it.
  const std::lock_guard lock(moment->mutex);
  if (moment->world != nullptr) return moment;
  const auto failed = [&](const StoreError& error) {
    forget(at);
    return failure(error);
  };
  auto reader = open_world(place_, StoreAccess::read_only);
  if (!reader) return failed(reader.error());
  const auto stored = (*reader)->stored_moment(at);
  if (!stored) return failed(stored.error());
  if (at - stored->at.version.seq > kEditsMax) {
    return failed(
        {StoreError::Kind::bad_request, (*reader)->file(), "keyframe",
         "none is near enough to seq=" + std::to_string(at) + " yet: the moment cannot be shown"});
  }
  const auto progress = [this](Sequence, Sequence) { return !is_cancelled_.load(); };
  auto world = WorldAt::open(**reader, generator_, at, progress);
  if (!world) return failed(world.error());
  moment->reader = *std::move(reader);
  moment->world = std::make_unique<WorldAt>(*std::move(world));
  return moment;
}

void Moments::forget(Sequence at) {
  const std::lock_guard lock(mutex_);
  kept_.remove_if([at](const auto& kept) { return kept.first == at; });
}

StoreResult<LogEnd> Moments::open(Sequence at) {
  const auto moment = find(at);
  if (!moment) return failure(moment.error());
  return (*moment)->world->end();
}

StoreResult<LogEnd> Moments::open_at_time(TimeUs utc_us) {
  const auto reader = open_world(place_, StoreAccess::read_only);
  if (!reader) return failure(reader.error());
  const auto seq = (*reader)->sequence_at(utc_us);
  if (!seq) return failure(seq.error());
  return open(*seq);
}

StoreResult<Chunk> Moments::chunk(Sequence at, const ChunkKey& key) {
  auto made = made_chunk(at, key);
  // Retention may have moved the beginning of the log past the edits that the moment has read.
  if (made || made.error().kind != StoreError::Kind::bad_request) return made;
  forget(at);
  return made_chunk(at, key);
}

StoreResult<Chunk> Moments::made_chunk(Sequence at, const ChunkKey& key) {
  const auto moment = find(at);
  if (!moment) return failure(moment.error());
  const std::lock_guard lock((*moment)->mutex);
  if (is_cancelled_.load())
    return failure(StoreError{StoreError::Kind::cancelled, {}, {}, "the server stops"});
  return (*moment)->world->chunk(key);
}

}  // namespace runstone
