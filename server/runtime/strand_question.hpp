// StrandQuestion: a question that one thread asks the world strand (WorldStrand::ask()), with its
// answer. The thread that asks and the strand share it.
#pragma once
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "common/core/result.hpp"

namespace runstone {

template <class T>
struct AnswerType {
  using type = Result<T, std::string>;
};
template <class T>
struct AnswerType<Result<T, std::string>> {
  using type = Result<T, std::string>;
};
/// The result for the thread that asks: an answer of the type T, or a line that says why there is
/// none.
template <class T>
using AnswerOf = typename AnswerType<T>::type;

/// `Question` returns an optional, which is empty as long as there is no answer.
template <class Question>
class StrandQuestion {
 public:
  using Answer = std::invoke_result_t<Question&>;

  explicit StrandQuestion(Question question) : question_(std::move(question)) {}

  /// Runs the question, unless nobody waits for its answer any more. Returns false if it is to run
  /// again. Thread: the world strand.
  bool is_answered() {
    const std::lock_guard guard(mutex_);
    if (is_over_) return true;
    answer_ = question_();
    if (!answer_) return false;
    is_over_ = true;
    answered_.notify_one();
    return true;
  }
  /// Waits for the answer, and for a run of the question that is under way. Returns nullopt if
  /// there is no answer within `longest`. The question does not run any more then.
  Answer wait(std::chrono::milliseconds longest) {
    const auto is_here = [this] { return answer_.has_value(); };
    std::unique_lock lock(mutex_);
    if (longest == std::chrono::milliseconds::max()) {
      answered_.wait(lock, is_here);  // the moment when that time is over cannot be expressed
    } else {
      answered_.wait_for(lock, longest, is_here);
    }
    is_over_ = true;
    return std::move(answer_);
  }

 private:
  std::mutex mutex_;
  std::condition_variable answered_;
  // Guarded by mutex_.
  Question question_;
  Answer answer_;
  bool is_over_ = false;  // the question does not run any more
};

}  // namespace runstone
