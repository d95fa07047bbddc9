// WorldStrand: runs tasks one at a time, in the order in which they were posted, on the I/O
// threads. Everything that touches WorldServer runs as a task of this strand. After every task the
// strand calls `after_task`, so that no caller can forget the work that any task may make
// necessary. Other threads ask the world with ask() and ask_until(). Threads: post() may be called
// from any thread, ask() and ask_until() from any but the I/O threads.
#pragma once
#include <asio/bind_executor.hpp>
#include <asio/error_code.hpp>
#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <asio/strand.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/result.hpp"
#include "server/runtime/strand_question.hpp"

namespace runstone {

class WorldStrand {
 public:
  /// No task waits for a disk or a peer, so an answer takes longer than this only if no thread runs
  /// the strand.
  static constexpr std::chrono::milliseconds kAnswerTime{30'000};
  /// The caller waits for as long as it takes.
  static constexpr std::chrono::milliseconds kAnyTime = std::chrono::milliseconds::max();

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
      finish_task();
    });
  }

  /// Runs `question()` as a task behind the tasks that were posted before, and waits. Returns what
  /// the question returns, as a Result<T, std::string> unless it is one. Fails if the question has
  /// not begun within `longest`. It never runs then, so it may refer to what the caller holds. A
  /// question that has begun is waited for. Requires that the I/O context outlives the call, and
  /// that the calling thread does not run it, as all coroutines do: it would wait for itself.
  template <class Question>
  AnswerOf<std::invoke_result_t<Question&>> ask(Question question,
                                                std::chrono::milliseconds longest = kAnswerTime) {
    using Answer = std::invoke_result_t<Question&>;
    return ask_until(
        [question = std::move(question)]() mutable { return std::optional<Answer>(question()); },
        longest);
  }
  /// Waits until `question()`, which returns an optional, returns a value: it runs as for ask(),
  /// and again behind every later task of the strand. Fails if there is no value within `longest`.
  /// The question does not run any more then. Requires that the calling thread does not run the
  /// I/O context.
  template <class Question>
  AnswerOf<typename std::invoke_result_t<Question&>::value_type> ask_until(
      Question question, std::chrono::milliseconds longest = kAnswerTime) {
    RUNSTONE_ASSERT(!strand_.get_inner_executor().running_in_this_thread());
    const auto asked = std::make_shared<StrandQuestion<Question>>(std::move(question));
    post([this, asked] { open_questions_.push_back([asked] { return asked->is_answered(); }); });
    auto answer = asked->wait(longest);
    if (!answer) return failure("the server is busy: it has not answered in time");
    return *std::move(answer);
  }

  /// Runs `task(error)` when the timer expires or is cancelled.
  template <class Task>
  void wait(asio::steady_timer& timer, Task task) {
    timer.async_wait(asio::bind_executor(
        strand_, [this, task = std::move(task)](const asio::error_code& error) mutable {
          task(error);
          finish_task();
        }));
  }
  /// Returns a timer to be used with wait().
  asio::steady_timer make_timer() { return asio::steady_timer(strand_); }

  /// Returns true inside a task.
  bool is_current() const { return strand_.running_in_this_thread(); }

 private:
  void finish_task() {
    std::erase_if(open_questions_, [](const auto& is_answered) { return is_answered(); });
    after_task_();
  }

  asio::strand<asio::io_context::executor_type> strand_;
  const std::function<void()> after_task_;
  std::vector<std::function<bool()>> open_questions_;  // used on the strand
};

}  // namespace runstone
