#include "server/world/order/authority.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_memory.hpp"

namespace runstone {
namespace {

/// Returns the bytes that an edit takes on each of the stacks of the chunks that it touches.
std::size_t stack_bytes_of(const EditDescriptor& edit, std::size_t chunks) {
  return own_bytes(edit) + sizeof(Sequence) + shared_bytes(edit) / chunks;
}

}  // namespace

Authority::Authority(const EditLimits& limits, const LogPosition& log)
    : limits_(limits),
      epoch_(log.epoch),
      last_epoch_(log.last_epoch),
      head_(log.last),
      timed_from_(log.last + 1),
      log_clock_(log.last_time_us, log.begin_us),
      chunks_(limits.chunk_edge),
      queue_(limits.chunk_edge) {}

void Authority::replay_onto_stack(const EditRecord& record) {
  const std::vector<ChunkCoord> touched = touched_chunks(record.edit, limits_.chunk_edge);
  const std::size_t bytes = stack_bytes_of(record.edit, std::max<std::size_t>(1, touched.size()));
  for (const ChunkCoord at : touched)
    chunks_.replay_onto_stack({0, at}, record.version, record.edit, bytes);
}

Result<void, RejectReason> Authority::enqueue(const EditOffer& offer) {
  if (resolved_.knows(offer.op)) return failure(resolved_.answer_to(offer.op));
  const auto refusal = offer.cause == Cause::player ? check_edit(offer.edit, limits_)
                                                    : check_server_edit(offer.edit, limits_);
  if (refusal) {
    resolved_.reject(offer.op, *refusal);
    return failure(*refusal);
  }
  resolved_.raise(offer.op);
  queue_.push(offer);
  return {};
}

Sequence Authority::subject_of(const EditOffer& offer, Sequence seq) {
  if (offer.cause != Cause::player) return offer.subject;
  return offer.is_of_large_action ? large_actions_.order(offer.op, offer.action, seq)
                                  : actions_.order(offer.op, offer.action, seq);
}

std::optional<OrderedBatch> Authority::commit(const Clocks& now, std::uint64_t large_room) {
  log_clock_.advance(now);
  const std::vector<EditOffer> offers = queue_.take(large_room);
  if (offers.empty()) return std::nullopt;
  OrderedBatch batch;
  batch.commit.epoch = last_epoch_ = epoch_;
  for (const EditOffer& offer : offers) {
    const Version version{epoch_, ++head_};
    OrderedEdit ordered;
    ordered.seq = version.seq;
    ordered.op = offer.op;
    ordered.cause = offer.cause;
    ordered.submitted_us = offer.submitted_us;
    ordered.ordered_us = now.steady_us;
    if (offer.cause == Cause::player) edit_waits_.add(now.steady_us - offer.arrived_us);
    ordered.edit = offer.edit;
    ordered.subject = subject_of(offer, version.seq);
    const Sequence subject = ordered.subject;
    push(std::move(ordered), version, batch);
    EditRecord& record = batch.records.emplace_back(
        EditRecord{version, offer.op, 0, offer.cause, offer.edit, subject});
    if (corrects_time(record)) {
      log_clock_.accept_wall_clock();
      timed_from_ = version.seq;
    }
    record.time_us = log_clock_.stamp();
  }
  publish_touched(batch);
  return batch;
}

void Authority::accept_wall_clock() {
  RUNSTONE_ASSERT(log_clock_.ahead_us() <= 0);
  log_clock_.accept_wall_clock();
  timed_from_ = head_ + 1;
}

OrderedBatch Authority::apply_ordered(std::span<const LogPartRecord> records, const Clocks& now) {
  OrderedBatch batch;
  batch.commit.epoch = last_epoch_ = records.front().record.version.epoch;
  for (const LogPartRecord& part : records) {
    const EditRecord& record = part.record;
    RUNSTONE_ASSERT(record.version.seq == head_ + 1);
    RUNSTONE_ASSERT(record.version.epoch == batch.commit.epoch);
    ++head_;
    log_clock_.note_ordered(record.time_us, corrects_time(record));
    if (corrects_time(record)) timed_from_ = head_;
    resolved_.raise(record.op);
    OrderedEdit ordered;
    ordered.seq = head_;
    ordered.op = record.op;
    ordered.cause = record.cause;
    ordered.submitted_us = part.submitted_us;
    ordered.ordered_us = now.steady_us;
    ordered.edit = record.edit;
    ordered.subject = record.subject;
    push(std::move(ordered), record.version, batch);
    batch.records.push_back(record);
  }
  publish_touched(batch);
  return batch;
}

void Authority::push(OrderedEdit ordered, Version version, OrderedBatch& batch) {
  std::vector<ChunkKey>& touched = batch.touched.emplace_back();
  for (const ChunkCoord at : touched_chunks(ordered.edit, limits_.chunk_edge))
    touched.push_back({0, at});
  const std::size_t stacked =
      stack_bytes_of(ordered.edit, std::max<std::size_t>(1, touched.size()));
  for (const ChunkKey& key : touched)
    ordered.previous.push_back(chunks_.push(key, version, ordered.edit, stacked));
  batch.all_touched.insert(batch.all_touched.end(), touched.begin(), touched.end());
  batch.commit.edits.push_back(std::move(ordered));
}

void Authority::publish_touched(OrderedBatch& batch) {
  std::vector<ChunkKey>& all = batch.all_touched;
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  for (const ChunkKey& key : all) {
    batch.before.push_back(chunks_.find(key));
    chunks_.publish(key);
  }
}

}  // namespace runstone
