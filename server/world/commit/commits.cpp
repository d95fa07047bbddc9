#include "server/world/commit/commits.hpp"

#include <algorithm>
#include <iterator>

#include "common/core/assert.hpp"
#include "protocol/codec/commit_encoder.hpp"
#include "server/interest/audiences.hpp"

namespace runstone {
namespace {

/// Merges `more` into `sessions`; both ascend. Chunks in one place mostly have the same
/// subscribers, and equal lists cost one comparison.
void add_sessions(std::span<const SessionId> more, std::vector<SessionId>& sessions,
                  std::vector<SessionId>& scratch) {
  RUNSTONE_DASSERT(std::ranges::is_sorted(more));
  if (std::ranges::equal(more, sessions)) return;
  scratch.clear();
  std::ranges::set_union(sessions, more, std::back_inserter(scratch));
  sessions.swap(scratch);
}

}  // namespace

/// Returns for each edit the sessions that see one of its chunks, and the session of its client,
/// ascending.
std::vector<std::vector<SessionId>> Commits::receivers_of(const OrderedBatch& batch) const {
  std::vector<std::vector<SessionId>> receivers(batch.commit.edits.size());
  std::vector<SessionId> scratch;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    for (const ChunkKey& key : batch.touched[i])
      add_sessions(ground_.subscribers(key), receivers[i], scratch);
    const OperationId& op = batch.commit.edits[i].op;
    const Session* author = sessions_.of_client(op.author, op.instance);
    if (author == nullptr) continue;
    const auto at = std::ranges::lower_bound(receivers[i], author->id);
    if (at == receivers[i].end() || *at != author->id) receivers[i].insert(at, author->id);
  }
  return receivers;
}

/// Handles a message with these edits of a commit that did not fit the session's queue. The touched
/// chunks become outdated for the session. Each edit of its client gets a small answer, because a
/// snapshot does not show whether an edit was applied.
void Commits::drop_edits_for(SessionId session, const OrderedBatch& batch,
                             const std::vector<std::uint32_t>& edits, const Clocks& now) {
  Session* const mine = sessions_.find(session);
  if (mine == nullptr) return;
  for (const std::uint32_t i : edits) ground_.mark_outdated(*mine, batch.touched[i], now);
  for (const std::uint32_t i : edits) {
    const OrderedEdit& edit = batch.commit.edits[i];
    if (edit.op.author != mine->author || edit.op.instance != mine->instance) continue;
    receipts_.reject(*mine, {edit.op.seq, RejectReason::already_resolved,
                             "applied; its commit did not fit the queue", edit.seq});
  }
}

void Commits::send(const OrderedBatch& batch, const Clocks& now) {
  for (const OrderedEdit& edit : batch.commit.edits) {
    if (const Session* author = sessions_.of_client(edit.op.author, edit.op.instance))
      receipts_.expect_durable(*author, order_.head());
  }
  const auto receivers = receivers_of(batch);
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const OrderedEdit& edit = batch.commit.edits[i];
    const std::size_t work = edit_work(edit.edit, config_.chunk_edge);
    if (waits_for_room(work, edit.cause))
      order_.large_edits().charge(work * receivers[i].size(), now.steady_us);
  }
  const std::vector<Audience> audiences = audiences_of(receivers);
  if (audiences.empty()) return;
  const CommitEncoder encoder(batch.commit);
  for (const Audience& audience : audiences) {
    const EncodedMessage encoded = encode_message(encoder, audience.edits);
    const std::vector<SessionId> full = sessions_.send_to_all(audience.sessions, encoded);
    counters_.commit_bytes += encoded.bytes->size();
    counters_.commits_sent += audience.sessions.size() - full.size();
    for (const SessionId session : full) drop_edits_for(session, batch, audience.edits, now);
  }
}

void Commits::apply(const std::vector<EditRecord>& records) {
  if (const auto ground = rights_.apply(records)) {
    rights_.close_refused();
    ground_.rights_changed(*ground);
  }
  const bool has_materials = order_.apply_materials(records);
  const bool has_textures = order_.textures().apply(records);
  if (has_materials || has_textures) receipts_.send_materials_to_all();
  order_.library().apply(records);
}

void Commits::send_batch(const OrderedBatch& batch, const Clocks& now) {
  send(batch, now);
  ground_.edited(batch.all_touched, now);
}

bool Commits::commit(LargeEdits large, const Clocks& now) {
  auto batch = order_.commit(large, sessions_.count(), now);
  if (!batch) return false;
  apply(batch->records);
  order_.append(*batch);
  send_batch(*batch, now);
  return true;
}

void Commits::apply_ordered(std::span<const LogPartRecord> records, const Clocks& now) {
  while (!records.empty()) {
    const Epoch epoch = records.front().record.version.epoch;
    const auto other = std::ranges::find_if(
        records, [epoch](const LogPartRecord& part) { return part.record.version.epoch != epoch; });
    const auto same = records.first(static_cast<std::size_t>(other - records.begin()));
    if (epoch > order_.epoch()) begin_epoch(epoch);
    const OrderedBatch batch = order_.authority().apply_ordered(same, now);
    apply(batch.records);
    send_batch(batch, now);
    records = records.subspan(same.size());
  }
}

void Commits::begin_epoch(Epoch epoch) {
  order_.authority().begin_epoch(epoch);
  receipts_.send_epoch_to_all();
}

}  // namespace runstone
