#include "client/bots/play_bot.hpp"

#include <cmath>
#include <utility>

#include "protocol/codec/messages.hpp"

namespace runstone {
namespace {

/// Bound of the bytes of requests without an answer. A link with a much longer queue is closed.
constexpr std::size_t kOpenBytesMax = 2 * 1024 * 1024;
/// Voxels. In every world, and far from what is built.
constexpr std::int32_t kAloftHeight = kWorldLimit / 2;

std::vector<TimeUs> offsets_of(const RecordedAuthor& recorded) {
  std::vector<TimeUs> offsets;
  offsets.reserve(recorded.edits.size());
  for (const RecordedEdit& edit : recorded.edits) offsets.push_back(edit.offset_us);
  return offsets;
}

SessionConfig named(SessionConfig config, const std::string& name) {
  config.name = name;
  return config;
}

std::size_t bytes_bound(const EditDescriptor& edit) {
  const auto* paste = std::get_if<Paste>(&edit.shape);
  return 256 +
         (paste == nullptr ? descriptor_bytes_max(kind_of(edit)) : paste->clipboard->byte_size());
}

bool is_temporary(RejectReason reason) {
  return reason == RejectReason::rate_limited || reason == RejectReason::busy;
}

}  // namespace

PlayBot::PlayBot(const RecordedAuthor& recorded, SessionConfig config, double speed)
    : recorded_(recorded),
      session_(named(std::move(config), recorded.name)),
      schedule_(offsets_of(recorded), speed) {}

bool PlayBot::waits() const {
  return schedule_.unanswered() != 0 || schedule_.waiting() != 0 || !session_.is_open() ||
         !session_.replica().local_edits().all().empty();
}

void PlayBot::view_empty_chunk() {
  const Welcome& world = *session_.welcome();
  const auto down = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
  const View view{.centre = chunk_of({down(world.spawn.x), kAloftHeight, down(world.spawn.z)},
                                     world.chunk_edge)};
  if (!session_.view().same_chunks(view)) session_.set_view(view);
  session_.set_pose({world.spawn, 0, 0});
}

void PlayBot::step(TimeUs now_us) {
  session_.tick(now_us);
  drain_changes(now_us);
  counts_.due = schedule_.due(now_us);
  if (!session_.is_open()) return;
  view_empty_chunk();
  offer_due(now_us);
}

void PlayBot::offer_due(TimeUs now_us) {
  while (open_bytes_ < kOpenBytesMax &&
         session_.replica().local_edits().all().size() < kLocalEditsMax) {
    if (!held_) held_ = schedule_.next(now_us);
    if (!held_) return;
    const EditDescriptor& edit = recorded_.edits[held_->index].edit;
    if (session_.edit_wait_us(edit, now_us) > 0) return;
    const auto due = std::exchange(held_, std::nullopt);
    const auto sequence = session_.offer(edit, due->due_us, now_us);
    if (!sequence) {
      ++counts_.refused[sequence.error().what];
      schedule_.dropped();
      continue;
    }
    ++counts_.submitted;
    const Open open{*due, bytes_bound(edit)};
    open_bytes_ += open.bytes;
    open_.emplace(*sequence, open);
  }
}

void PlayBot::drain_changes(TimeUs now_us) {
  const ReplicaChanges changes = session_.replica().drain_changes();
  const auto close = [this](ClientSequence seq) -> std::optional<Open> {
    const auto found = open_.find(seq);
    if (found == open_.end()) return std::nullopt;
    const Open open = found->second;
    open_bytes_ -= open.bytes;
    open_.erase(found);
    return open;
  };
  for (const EditChange& edit : changes.edits) {
    if (edit.predicted || !edit.is_local) continue;
    const auto open = close(edit.op.seq);
    // The edit is not open if it was confirmed before and the server, which had lost it, ordered
    // it again.
    if (!open) continue;
    counts_.confirm_us.add(edit.applied_us - open->due.due_us);
    ++counts_.confirmed;
    schedule_.accepted();
  }
  for (const RejectedEdit& reject : changes.rejects) {
    const auto open = close(reject.seq);
    if (!open) continue;
    if (is_temporary(reject.reason)) {
      ++counts_.retried;
      schedule_.retry(open->due, now_us);
    } else {
      ++counts_.rejected[to_string(reject.reason)];
      schedule_.dropped();
    }
  }
  for (const ClientSequence seq : changes.unseen) {
    if (!close(seq)) continue;
    ++counts_.unseen;
    schedule_.dropped();
  }
  counts_.durable += changes.durable.size();
}

}  // namespace runstone
