// Child: a program that the lab started in a place, its output in a file. It dies with its Child, and with us.
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "tests/bench/network/place.hpp"

namespace runstone::bench {

class Child {
 public:
  /// `words`: the program's file and its arguments. `log` takes its standard output and error.
  static Result<std::unique_ptr<Child>, std::string> start(Place& place,
                                                           std::vector<std::string> words,
                                                           std::string log);
  /// Kills it if it still runs.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Waits until it ended, at most so long or until the lab is interrupted. Its status as of waitpid().
  std::optional<int> wait(double seconds);
  void terminate();
  /// What it and its threads had of the cores so far, seconds. 0 once it ended.
  double core_seconds() const;
  std::uint64_t resident_bytes() const;
  const std::string& log() const { return log_; }
  /// "NAME did WHAT; the end of its output: ...".
  std::string explain(const std::string& what) const;

 private:
  Child(pid_t pid, std::string name, std::string log);
  const pid_t pid_;
  const std::string name_, log_;
  std::optional<int> status_;
};

/// The lab was interrupted or terminated: everything that waits gives up. Set by a signal.
bool interrupted();
/// From now on SIGINT and SIGTERM interrupt the lab, until the next such signal ends the process.
void take_interrupts();

/// Until `holds`, looking every few milliseconds, at most so long or until the lab is interrupted. Returns whether it
/// does.
template <class F>
bool wait_until(double seconds, F&& holds);
/// Sleeps; false if the lab was interrupted.
bool pause_for(double seconds);

template <class F>
bool wait_until(double seconds, F&& holds) {
  constexpr double kStep = 0.005;
  for (double waited = 0;; waited += kStep) {
    if (holds()) return true;
    if (waited >= seconds || !pause_for(kStep)) return false;
  }
}

}  // namespace runstone::bench
