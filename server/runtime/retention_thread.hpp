// RetentionThread: removes the oldest edits of a world's log while people play, by a policy or by a
// command. It moves them into the base in many small parts (folds). A part is one transaction of
// the log writer, and the world is whole after each of them.
//   - The size of a part follows the time that the log writer took for the parts before
//     (next_fold_size()). A single edit is not divided, so a part with one edit of very many chunks
//     takes longer.
//   - After each part the thread rests 9 times as long as the part took, reading included. Then the
//     records that were queued meanwhile are on disk.
//   - It pauses while rollbacks, their previews and undos are under way: they read the log that it
//     would shorten.
//   - It removes no edit behind the checkpoint.
//   - At the end of a run it returns free space to the disk, in small parts too.
//   - A failure ends the run, not the server: the next run goes on where it ended.
// Threads: the constructor, the destructor and stop(): one; all others: any.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/generate/generator.hpp"
#include "server/admin/retention_state.hpp"
#include "server/history/fold_maker.hpp"
#include "server/history/retention_plan.hpp"
#include "server/store/log_writer.hpp"
#include "server/store/store.hpp"

namespace runstone {

struct RetentionPace {
  std::int64_t rest_parts = 9;  // a rest is so many times as long as the part before it
  std::chrono::nanoseconds first_run = std::chrono::minutes(5);  // after the start
  std::chrono::nanoseconds between_runs = std::chrono::hours(1);
  std::chrono::nanoseconds pause =
      std::chrono::milliseconds(200);  // between two looks whether to go on
};

class RetentionThread {
 public:
  /// Starts the thread. `generator` and `writer` must outlive the object. `days` is the policy; 0:
  /// no policy. `utc_now` returns the time in UTC.
  RetentionThread(std::string place, const Generator& generator, LogWriter& writer,
                  std::uint64_t days, std::function<TimeUs()> utc_now, RetentionPace pace = {});
  /// Calls stop().
  ~RetentionThread() { stop(); }
  RetentionThread(const RetentionThread&) = delete;
  RetentionThread& operator=(const RetentionThread&) = delete;

  /// Changes the policy. Ends a run of the policy before after its present part. The first run of a
  /// new policy begins after RetentionPace::between_runs, so that a typing error can be corrected.
  /// A run of run_now() goes on.
  void set_days(std::uint64_t days);
  /// Begins a run now, which keeps the edits of so many days. The run makes a new plan. It does not
  /// wait for a confirmation. Returns false if a run is under way.
  bool run_now(std::uint64_t days);
  /// Ends the run under way after its present part, or one that has not begun yet. Returns false if
  /// there is none.
  bool cancel();
  /// Pauses the run while `is_held` is true.
  void hold(bool is_held) { is_held_.store(is_held); }
  RetentionState state() const;
  /// Ends the thread. Waits for the present part. Requires that the writer still runs or has
  /// failed. Later calls do nothing.
  void stop();

 private:
  /// A run that was ordered.
  struct Order {
    std::uint64_t days = 0;
    bool is_confirmed = false;  // a person has seen the plan
  };

  void run();
  /// Waits for the next run. Returns nullopt if the thread must end.
  std::optional<Order> await_order();
  /// Removes the edits that the order does not keep. Fails with a sentence without a period.
  Result<void, std::string> carry_out(const Order& order);
  Result<void, std::string> remove_up_to(Store& reader, Sequence cut);
  Result<void, std::string> give_space_back();
  /// Waits until the run may go on. Returns false if it must end.
  bool may_go_on();
  /// Rests. Returns false if the run must end.
  bool rest(std::chrono::nanoseconds time);
  StoreResult<void> save(LogFold fold);
  void note_wait(std::string why);
  bool is_ending() const { return stopping_ || is_cancelled_; }

  const std::string place_;
  const Generator& generator_;
  LogWriter& writer_;
  const std::function<TimeUs()> utc_now_;
  const RetentionPace pace_;
  std::atomic<bool> is_held_{false};
  mutable std::mutex mutex_;  // a leaf: guards the members below
  std::condition_variable changed_;
  std::optional<Order> ordered_;
  RetentionState state_;
  bool is_confirmed_ = false;  // the run under way is of run_now()
  bool has_new_days_ = false;  // since await_order() has looked
  bool is_cancelled_ = false, stopping_ = false;
  std::thread thread_;  // starts last, because it uses the members above
};

}  // namespace runstone
