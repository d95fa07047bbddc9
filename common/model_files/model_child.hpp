// ModelChild: a running runstone-read-model, whose output is read with a deadline. Thread: one at a
// time.
#pragma once
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

class ModelChild {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts a program. The error is that of the system.
  static Result<ModelChild, std::string> start(const std::vector<std::string>& words,
                                               Clock::time_point deadline,
                                               std::function<bool()> should_continue);
  ModelChild(ModelChild&& other) noexcept;
  ModelChild& operator=(ModelChild&&) = delete;
  /// Kills the child if it runs, and waits for its end.
  ~ModelChild();

  /// Fills the span with the next bytes of standard output. Returns false at the end of the output,
  /// after the deadline, and when the child is not wanted any more.
  bool fill(std::span<std::uint8_t> to);
  /// Returns true if the output has ended. Waits for the next byte or the end.
  bool is_at_end();
  /// Waits for the end of the child. Returns its status of waitpid(), also when called again, or -1 if
  /// this object stopped waiting.
  int wait();
  /// Returns what the child has written to standard error, at most 4 KiB.
  const std::string& errors() const { return errors_; }

  enum class Stop : std::uint8_t { none, deadline, unwanted };
  /// Returns why this object stopped reading, or none if the child ended the output.
  Stop stopped() const { return stopped_; }

 private:
  ModelChild(int pid, int output, int error_output, Clock::time_point deadline,
             std::function<bool()> should_continue);
  bool receive();
  bool may_go_on();
  void read_errors();

  int pid_, output_, error_output_;  // -1: none
  Clock::time_point deadline_;
  std::function<bool()> should_continue_;
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // of the bytes in the buffer that fill() has not given
  std::string errors_;
  int status_ = -1;  // of waitpid(), when the child has ended
  Stop stopped_ = Stop::none;
};

}  // namespace runstone
