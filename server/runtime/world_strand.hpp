// WorldStrand: runs tasks one at a time, in the order in which they were posted, on the I/O
// threads. Everything that touches WorldServer runs as a task of this strand. After every task the
// strand calls `after_task`, so that no caller can forget the work that any task may make
// necessary. Threads: post() may be called from any thread.
#pragma once
#include <asio/bind_executor.hpp>
#include <asio/error_code.hpp>
#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <asio/strand.hpp>
#include <functional>
#include <utility>

namespace runstone {

class WorldStrand {
 public:
  /// `io` must outlive the strand. The strand must outlive the tasks that run on it.
  WorldStrand(asio::io_context& io, std::function<void()> after_task)
      : strand_(asio::make_strand(io)), after_task_(std::move(after_task)) {}
  WorldStrand(const WorldStrand&) = delete;
  WorldStrand& operator=(const WorldStrand&) = delete;

  /// Queues `task()` behind the tasks that were posted before.
  template <class Task>
  void post(Task task) {
    asio::post(strand_, [this, task = std::move(task)]() mutable {
      task();
      after_task_();
    });
  }

  /// Runs `task(error)` when the timer expires or is cancelled.
  template <class Task>
  void wait(asio::steady_timer& timer, Task task) {
    timer.async_wait(asio::bind_executor(
        strand_, [this, task = std::move(task)](const asio::error_code& error) mutable {
          task(error);
          after_task_();
        }));
  }
  /// Returns a timer to be used with wait().
  asio::steady_timer make_timer() { return asio::steady_timer(strand_); }

  /// Returns true inside a task.
  bool is_current() const { return strand_.running_in_this_thread(); }

 private:
  asio::strand<asio::io_context::executor_type> strand_;
  const std::function<void()> after_task_;
};

}  // namespace runstone
