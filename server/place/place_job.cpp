#include "server/place/place_job.hpp"

#include <utility>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {
namespace {

// The most edits, and the most work of edits, that a worker cuts in one call: its answer takes memory.
constexpr std::size_t kCutEditsMax = 128;
constexpr std::size_t kCutWorkMax = 512 * 1024;

}  // namespace

PlacedParts cut_parts(PasteSource& source, std::int32_t chunk_edge) {
  PlacedParts out;
  for (std::size_t work = 0; out.edits.size() < kCutEditsMax && work < kCutWorkMax;) {
    std::optional<EditDescriptor> edit = source.next();
    if (!edit) {
      out.is_last = true;
      break;
    }
    work += edit_work(*edit, chunk_edge);
    out.edits.push_back(*std::move(edit));
  }
  out.cells_done = source.cells_done();
  return out;
}

PlaceJob::PlaceJob(PlaceOrder order, const PasteLimits& paste, PlaceLimits limits)
    : order_(std::move(order)),
      limits_(limits),
      chunk_edge_(paste.chunk_edge),
      source_(std::make_shared<PasteSource>(order_.build, order_.at, order_.mask, order_.empty,
                                            paste)) {
  progress_.cells = source_->cells();
}

std::shared_ptr<PasteSource> PlaceJob::next_work() {
  if (state_ != State::placing || is_working_ || is_cut_ || parts_.size() >= limits_.parts_waiting)
    return nullptr;
  is_working_ = true;
  return source_;
}

void PlaceJob::computed(PlacedParts parts) {
  RUNSTONE_ASSERT(is_working_);
  is_working_ = false;
  if (state_ != State::placing) return;
  is_cut_ = parts.is_last;
  const std::uint64_t before = parts_.empty() ? progress_.cells_done : parts_.back().cells_done;
  const std::uint64_t cut = parts.cells_done - before;
  for (std::size_t i = 0; i < parts.edits.size(); ++i) {
    const std::uint64_t share = cut / parts.edits.size() * (i + 1);
    parts_.push_back({std::move(parts.edits[i]), before + share});
  }
  if (!parts_.empty()) parts_.back().cells_done = parts.cells_done;
}

void PlaceJob::work_failed(std::string what) {
  is_working_ = false;
  fail(std::move(what));
}

void PlaceJob::fail(std::string what) {
  if (state_ != State::placing) return;
  state_ = State::failed;
  progress_.error = std::move(what);
}

bool PlaceJob::has_queued(const WorldServer& world) const {
  const OperationId newest{order_.author, order_.instance, next_seq_ - 1};
  return first_op_ && world.order().authority().queue().has(newest);
}

void PlaceJob::cancel() {
  if (state_ == State::placing) state_ = State::cancelled;
}

void PlaceJob::step(WorldServer& world, const Clocks& now) {
  if (state_ != State::placing) return;
  if (!world.order().accepts_edits()) {
    // A worker may still cut. Its answer is dropped.
    return fail("the server stops, its log cannot be written, or another server owns the world");
  }
  const Authority& authority = world.order().authority();
  if (first_op_ && authority.large_actions().find(*first_op_) == LargeActions::Standing::ended) {
    state_ = State::undone;
    return;
  }
  // Large edits wait for their turn in the queue. The next slice comes behind them.
  if (has_queued(world)) return;
  note_sequences(world);
  order_slice(world, now);
  end_if_done(world);
}

void PlaceJob::order_slice(WorldServer& world, const Clocks& now) {
  std::vector<EditOffer> offers;
  std::vector<std::uint64_t> cells_done;
  std::deque<Part> slice;
  std::size_t work = 0;
  ClientSequence seq = next_seq_;
  while (!parts_.empty()) {
    const std::size_t next = edit_work(parts_.front().edit, chunk_edge_);
    if (!slice.empty() && work + next > limits_.slice_work) break;
    Part part = std::move(parts_.front());
    parts_.pop_front();
    if (auto why = refusal(world, part.edit)) {
      ++progress_.edits_refused;
      progress_.refusal = *std::move(why);
      if (slice.empty()) progress_.cells_done = part.cells_done;
      continue;
    }
    work += next;
    const OperationId op{order_.author, order_.instance, seq++};
    if (!first_op_) first_op_ = op;
    EditOffer offer{op, Cause::player, now.steady_us, part.edit};
    offer.action = first_op_->seq;
    offer.is_of_large_action = true;
    offer.arrived_us = now.steady_us;
    offers.push_back(std::move(offer));
    slice.push_back(std::move(part));
  }
  if (offers.empty()) return;
  const ServerEditsResult answer = world.changes().order_edits(offers, order_.payer, now);
  if (answer.state == ServerEditsResult::State::taken)
    return fail("a client has come under the job's instance and taken its client sequences");
  progress_.waits_for = answer.reason;
  for (std::size_t i = 0; i < answer.count; ++i) {
    progress_.voxels += counted_voxels(slice.front().edit);
    progress_.cells_done = slice.front().cells_done;
    slice.pop_front();
  }
  next_seq_ += answer.count;
  progress_.edits += answer.count;
  note_sequences(world);
  while (!slice.empty()) {
    parts_.push_front(std::move(slice.back()));
    slice.pop_back();
  }
}

std::optional<std::string> PlaceJob::refusal(const WorldServer& world,
                                             const EditDescriptor& edit) const {
  if (world.order().authority().check(edit)) return "an edit of it is outside the limits of edits";
  return world.rights().edit_refusal(order_.author, edit);
}

void PlaceJob::note_sequences(const WorldServer& world) {
  if (progress_.edits == 0) return;
  if (progress_.first == 0)
    progress_.first = world.order().authority().large_actions().first_of(*first_op_);
  // Edits of others may be among them.
  progress_.last = world.order().head();
}

void PlaceJob::end_if_done(const WorldServer& world) {
  if (state_ != State::placing || is_working_ || !is_cut_ || !parts_.empty()) return;
  if (has_queued(world)) return;
  note_sequences(world);
  progress_.cells_done = progress_.cells;
  state_ = State::done;
}

}  // namespace runstone
