#include "server/runtime/retention_thread.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "common/os/low_priority.hpp"
#include "server/runtime/logging.hpp"
#include "server/runtime/writer_answer.hpp"
#include "server/store/removed_history.hpp"

namespace runstone {
namespace {

using RetentionClock = std::chrono::steady_clock;

// A part that gives space back takes about a millisecond for 64 pages.
constexpr std::uint32_t kPagesBack = 256;

}  // namespace

RetentionThread::RetentionThread(std::string place, const Generator& generator, LogWriter& writer,
                                 std::uint64_t days, std::function<TimeUs()> utc_now,
                                 RetentionPace pace)
    : place_(std::move(place)),
      generator_(generator),
      writer_(writer),
      utc_now_(std::move(utc_now)),
      pace_(pace) {
  state_.days = days;
  thread_ = std::thread([this] { run(); });
}

void RetentionThread::set_days(std::uint64_t days) {
  {
    const std::lock_guard guard(mutex_);
    if (state_.days == days) return;
    state_.doubt.clear();
    state_.days = days;
    if (state_.is_running && !is_confirmed_) is_cancelled_ = true;
    has_new_days_ = true;
  }
  changed_.notify_all();
}

bool RetentionThread::run_now(std::uint64_t days) {
  {
    const std::lock_guard guard(mutex_);
    if (state_.is_running || ordered_ || stopping_) return false;
    ordered_ = Order{days, true};
  }
  changed_.notify_all();
  return true;
}

bool RetentionThread::cancel() {
  {
    const std::lock_guard guard(mutex_);
    if (!state_.is_running && !ordered_) return false;
    ordered_.reset();
    is_cancelled_ = true;
  }
  changed_.notify_all();
  return true;
}

RetentionState RetentionThread::state() const {
  const LogWriter::Counters counters = writer_.counters();
  const std::lock_guard guard(mutex_);
  RetentionState now = state_;
  now.is_running = now.is_running || ordered_.has_value();
  now.edits = counters.folded_edits;
  now.parts = counters.folds;
  now.writer_us = counters.fold_us;
  now.writer_us_max = counters.fold_us_max;
  return now;
}

void RetentionThread::stop() {
  {
    const std::lock_guard guard(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void RetentionThread::note_wait(std::string why) {
  const std::lock_guard guard(mutex_);
  state_.waits_for = std::move(why);
}

bool RetentionThread::rest(std::chrono::nanoseconds time) {
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, time, [this] { return is_ending(); });
}

bool RetentionThread::may_go_on() {
  bool has_waited = false;
  while (is_held_.load()) {
    if (!std::exchange(has_waited, true))
      note_wait("rollbacks, their previews or undos are under way, which read the log");
    if (!rest(pace_.pause)) return false;
  }
  if (has_waited) note_wait("");
  const std::lock_guard guard(mutex_);
  return !is_ending();
}

StoreResult<void> RetentionThread::save(LogFold fold) {
  const auto answer = std::make_shared<WriterAnswer<void>>();
  const bool is_taken = writer_.fold_log(
      std::move(fold), [answer](StoreResult<void> result) { answer->set(result); });
  if (is_taken) return answer->wait();
  return failure(
      StoreError{StoreError::Kind::cancelled, place_, "retention", "the log writer has ended"});
}

Result<void, std::string> RetentionThread::remove_up_to(Store& reader, Sequence cut) {
  FoldMaker maker(reader, generator_);
  FoldSize size;
  while (may_go_on()) {
    const auto begun = RetentionClock::now();
    const auto checkpoint = reader.checkpoint();
    if (!checkpoint) return failure(checkpoint.error().message());
    auto fold = maker.next(std::min(cut, *checkpoint), size);
    if (!fold) return failure(fold.error().message());
    if (!fold->has_value()) return {};  // the rest has no snapshots yet: the next run removes it
    const LogEnd head = (*fold)->to;
    const std::uint64_t before_us = writer_.counters().fold_us;
    const auto saved = save(**std::move(fold));
    if (!saved) return failure(saved.error().message());
    size = next_fold_size(size, std::chrono::microseconds(writer_.counters().fold_us - before_us));
    {
      const std::lock_guard guard(mutex_);
      state_.head = head;
    }
    if (!rest(pace_.rest_parts * (RetentionClock::now() - begun))) break;
  }
  return {};
}

Result<void, std::string> RetentionThread::give_space_back() {
  while (may_go_on()) {
    const auto begun = RetentionClock::now();
    const auto answer = std::make_shared<WriterAnswer<bool>>();
    const bool is_taken = writer_.give_back_space(
        kPagesBack, [answer](StoreResult<bool> result) { answer->set(result); });
    if (!is_taken) return {};
    const auto has_more = answer->wait();
    if (!has_more) return failure(has_more.error().message());
    if (!*has_more || !rest(pace_.rest_parts * (RetentionClock::now() - begun))) break;
  }
  return {};
}

Result<void, std::string> RetentionThread::carry_out(const Order& order) {
  const auto reader = open_world(place_, StoreAccess::read_only);
  if (!reader) return failure(reader.error().message());
  const auto plan = plan_retention(**reader, order.days, utc_now_());
  if (!plan) return failure(plan.error().message());
  const std::string doubt = order.is_confirmed ? "" : plan->doubt;
  bool is_new_doubt = false;
  {
    const std::lock_guard guard(mutex_);
    state_.head = plan->head;
    state_.cut = plan->cut.version.seq;
    is_new_doubt = std::exchange(state_.doubt, doubt) != doubt;
  }
  if (!doubt.empty()) {
    if (is_new_doubt) logger("store").warn("RETENTION WAITS: {}", doubt);
    return {};
  }
  if (plan->removes_nothing()) return {};
  logger("store").info("retention: days={} edits={} seq={} removes them from the log in parts",
                       order.days, plan->volume.edits, plan->cut.version.seq);
  if (auto removed = remove_up_to(**reader, plan->cut.version.seq); !removed) return removed;
  if (auto given = give_space_back(); !given) return given;
  const auto head = (*reader)->log_head();
  if (head) logger("store").info("retention: the history was {}", removed_up_to(*head));
  return {};
}

std::optional<RetentionThread::Order> RetentionThread::await_order() {
  std::unique_lock lock(mutex_);
  const auto pause = state_.runs == 0 ? pace_.first_run : pace_.between_runs;
  for (auto due = RetentionClock::now() + pause;;) {
    changed_.wait_until(lock, due, [this] { return stopping_ || ordered_ || has_new_days_; });
    if (stopping_) return std::nullopt;
    if (std::exchange(has_new_days_, false) && !ordered_) {
      due = RetentionClock::now() + pace_.between_runs;
      continue;
    }
    if (!ordered_ && state_.days > 0) ordered_ = Order{state_.days, false};
    if (ordered_) {
      const Order order = *std::exchange(ordered_, std::nullopt);
      state_.is_running = true;
      is_confirmed_ = order.is_confirmed;
      is_cancelled_ = false;
      return order;
    }
    due = RetentionClock::now() + pace_.between_runs;
  }
}

void RetentionThread::run() {
  lower_priority();
  lower_disk_priority();
  while (const auto order = await_order()) {
    const auto done = carry_out(*order);
    bool is_stopping = false;
    {
      const std::lock_guard guard(mutex_);
      state_.is_running = false;
      state_.waits_for.clear();
      ++state_.runs;
      state_.failure = done ? "" : done.error();
      state_.failures = done ? 0 : state_.failures + 1;
      is_stopping = stopping_;
    }
    if (!done && !is_stopping)
      logger("store").error(
          "RETENTION FAILED: {}: the world is whole, and the next run goes on where this one ended",
          done.error());
  }
}

}  // namespace runstone
