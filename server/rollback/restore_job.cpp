#include "server/rollback/restore_job.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/rollback/restore_paste.hpp"
#include "server/rollback/restore_plan.hpp"
#include "server/rollback/slice_edits.hpp"

namespace runstone {
namespace {

RestoredChunk restored_chunk(const ChunkKey& key, const StoreResult<RestorePlan>& plan,
                             bool is_careful, const Selection& selection) {
  RestoredChunk chunk;
  chunk.key = key;
  if (!plan) {
    chunk.error = plan.error().message();
    return chunk;
  }
  const VoxelPos origin = origin_of(key.at, selection.chunk_edge);
  chunk.version = plan->version;
  chunk.subject = plan->subject;
  chunk.voxels = plan->voxels;
  chunk.edits = is_careful ? careful_restore_pastes(plan->now, plan->differences, origin)
                           : restore_pastes(plan->now, plan->differences, origin);
  return chunk;
}

}  // namespace

std::vector<RestoredChunk> restore_chunks(WorldReader& reader, const Generator& generator,
                                          const RestoreWork& work,
                                          const ShouldContinue& should_continue) {
  RestorePlanner planner(reader, generator, should_continue);
  std::vector<RestorePlanner::Item> items;
  for (const RestoreWork::Item& item : work.items)
    items.push_back({item.key, work.selection->chunks.at(item.key)});
  std::vector<RestoredChunk> out;
  planner.plan_all(items, work.selection->box, work.end,
                   [&](const ChunkKey& key, const StoreResult<RestorePlan>& plan) {
                     const bool is_careful = work.items[out.size()].is_careful;
                     out.push_back(restored_chunk(key, plan, is_careful, *work.selection));
                     return true;
                   });
  for (std::size_t i = out.size(); i < items.size(); ++i) {
    out.push_back({});  // no longer wanted
    out.back().key = items[i].key;
    out.back().error = out[i - 1].error;
  }
  return out;
}

RestoreJob::RestoreJob(RestoreOrder order, RestoreLimits limits)
    : order_(std::move(order)), limits_(limits), next_seq_(order_.first_seq) {
  for (const auto& [key, edits] : order_.selection->chunks) waiting_.push_back(key);
  progress_.chunks = waiting_.size();
  end_if_done();
}

void RestoreJob::end_if_done() {
  if (state_ != State::applying || is_working_ || !waiting_.empty() || !planned_.empty()) return;
  state_ = progress_.chunks_failed == 0 ? State::done : State::failed;
}

std::size_t RestoreJob::work_of(const RestoredChunk& chunk) const {
  std::size_t work = 0;
  for (const EditDescriptor& edit : chunk.edits)
    work += edit_work(edit, order_.selection->chunk_edge);
  return work;
}

bool RestoreJob::is_careful(const ChunkKey& key) const {
  const auto hits = collisions_.find(key);
  return hits != collisions_.end() && hits->second >= kCollisionsMax;
}

std::optional<RestoreWork> RestoreJob::next_work(const WorldServer& world) {
  if (!world.order().accepts_edits()) return std::nullopt;
  if (state_ != State::applying || is_working_ || planned_.size() >= limits_.slice_chunks)
    return std::nullopt;
  RestoreWork work;
  work.selection = order_.selection;
  work.end = world.order().durable();
  // A pass counts only if more of the log is durable than at the last one.
  const bool is_new_pass = work.end > std::exchange(last_end_, work.end);
  // Only the durable log can be read. The plan of a chunk whose last edit is not in it would have
  // an old version.
  for (std::size_t looked = waiting_.size(); looked > 0 && work.items.size() < limits_.work_chunks;
       --looked) {
    const ChunkKey key = waiting_.front();
    waiting_.pop_front();
    const bool is_durable = world.order().chunks().version(key).seq <= work.end;
    if (!is_durable && is_new_pass && ++passes_[key] >= kPassesMax)
      collisions_[key] = kCollisionsMax;
    if (is_durable || is_careful(key)) {
      work.items.push_back({key, is_careful(key)});
    } else {
      waiting_.push_back(key);
    }
  }
  if (work.items.empty()) return std::nullopt;
  is_working_ = true;
  return work;
}

void RestoreJob::computed(std::vector<RestoredChunk> chunks) {
  RUNSTONE_ASSERT(is_working_);
  is_working_ = false;
  if (state_ != State::applying) return;
  for (RestoredChunk& chunk : chunks) {
    if (!chunk.error.empty()) {
      ++progress_.chunks_failed;
      if (progress_.error.empty()) progress_.error = chunk.error;
    } else if (chunk.edits.empty()) {
      ++progress_.chunks_done;
      begun_.erase(chunk.key);
    } else {
      planned_.push_back(std::move(chunk));
    }
  }
  end_if_done();
}

void RestoreJob::work_failed(std::string what) {
  is_working_ = false;
  if (state_ != State::applying) return;
  state_ = State::failed;
  progress_.error = std::move(what);
}

void RestoreJob::cancel() {
  if (state_ == State::applying) state_ = State::cancelled;
}

void RestoreJob::step(WorldServer& world, const Clocks& now) {
  if (state_ != State::applying) return;
  // A worker may still plan chunks. Its answer is dropped, because the job has ended.
  if (!world.order().accepts_edits()) {
    state_ = State::failed;
    progress_.error =
        "the server stops, its log cannot be written, or another server owns the world";
    return;
  }
  if (planned_.empty()) return;
  world.commit(now);  // no version changes from here to Changes::order_edits()
  std::vector<RestoredChunk> slice;
  SliceEdits edits(world, order_.author, order_.selection->chunk_edge);
  while (!planned_.empty() && slice.size() < limits_.slice_chunks &&
         (slice.empty() || edits.work() + work_of(planned_.front()) <= limits_.slice_work)) {
    RestoredChunk chunk = std::move(planned_.front());
    planned_.pop_front();
    if (!is_careful(chunk.key) &&
        world.order().chunks().version(chunk.key).seq != chunk.version.seq) {
      ++progress_.collisions;
      ++collisions_[chunk.key];
      waiting_.push_back(chunk.key);
      continue;
    }
    leave_protected(chunk, world);
    if (chunk.edits.empty()) {
      ++progress_.chunks_done;
      continue;
    }
    for (const EditDescriptor& edit : chunk.edits)
      edits.add(edit, order_.subject != 0 ? order_.subject : chunk.subject);
    slice.push_back(std::move(chunk));
  }
  if (slice.empty()) return end_if_done();
  std::vector<EditOffer> offers;
  for (std::size_t i = 0; i < edits.edits().size(); ++i) {
    offers.push_back({{order_.author, order_.instance, next_seq_ + i},
                      order_.cause,
                      now.steady_us,
                      edits.edits()[i],
                      edits.subject(i)});
  }
  const Sequence before = world.order().head();
  const ServerEditsResult answer = world.changes().order_edits(offers, order_.payer, now);
  if (answer.state == ServerEditsResult::State::taken) {
    state_ = State::failed;
    progress_.error =
        "a client has come under the server's instance and taken its client sequences";
    return;
  }
  progress_.waits_for = answer.reason;
  if (answer.count > 0) {
    next_seq_ += answer.count;
    progress_.edits += answer.count;
    if (progress_.first == 0) progress_.first = before + 1;
    progress_.last = world.order().head();
  }
  take_written(std::move(slice), edits.added_in(answer.count), world);
  end_if_done();
}

void RestoreJob::leave_protected(RestoredChunk& chunk, const WorldServer& world) {
  std::erase_if(chunk.edits, [&](const EditDescriptor& edit) {
    auto why = world.rights().edit_refusal(order_.author, edit);
    if (!why) return false;
    ++progress_.edits_refused;
    chunk.voxels -= counted_voxels(edit);
    progress_.refusal = *std::move(why);
    return true;
  });
}

void RestoreJob::take_written(std::vector<RestoredChunk> slice, std::size_t count,
                              const WorldServer& world) {
  auto chunk = slice.begin();
  for (; chunk != slice.end() && count > 0; ++chunk) {
    const std::size_t mine = std::min(count, chunk->edits.size());
    const auto end = chunk->edits.begin() + static_cast<std::ptrdiff_t>(mine);
    for (auto edit = chunk->edits.begin(); edit != end; ++edit) {
      progress_.voxels += counted_voxels(*edit);
      chunk->voxels -= counted_voxels(*edit);
    }
    count -= mine;
    chunk->edits.erase(chunk->edits.begin(), end);
    if (begun_.insert(chunk->key).second) ++progress_.chunks_changed;
    if (!chunk->edits.empty()) {
      // No other edit came in between, so the rest of the plan fits the new version.
      chunk->version = world.order().chunks().version(chunk->key);
      break;
    }
    ++progress_.chunks_done;
    begun_.erase(chunk->key);
  }
  // The next step compares the versions again.
  for (auto rest = slice.end(); rest != chunk;) planned_.push_front(std::move(*--rest));
}

}  // namespace runstone
