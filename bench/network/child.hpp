// Child: a program that the testbed starts in a place, with its output in a file. It ends with its
// Child and with this process.
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/network/place.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

class Child {
 public:
  /// Starts a program. `words` are the program's file and its arguments. `log` receives its
  /// standard output and error.
  static Result<std::unique_ptr<Child>, std::string> start(Place& place,
                                                           std::vector<std::string> words,
                                                           std::string log);
  /// Kills the program if it still runs.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Waits until the program ends, at most `seconds` or until the testbed is interrupted. Returns
  /// its status in the form of waitpid(), or nullopt if it still runs.
  std::optional<int> wait(double seconds);
  void terminate();
  /// Returns the processor time of the program and its threads so far, in seconds; 0 after its end.
  double core_seconds() const;
  std::uint64_t resident_bytes() const;
  /// Returns the bytes that the program has caused to be written to disks so far.
  std::uint64_t written_bytes() const;
  /// Returns the number of files and sockets that the program has open.
  std::size_t open_files() const;
  const std::string& log() const { return log_; }
  /// Returns "NAME did WHAT; the end of its output: ...".
  std::string explain(const std::string& what) const;

 private:
  Child(pid_t pid, std::string name, std::string log);
  const pid_t pid_;
  const std::string name_, log_;
  std::optional<int> status_;
};

/// Returns true if a signal interrupted or terminated the testbed. Every wait then ends.
bool interrupted();
/// Makes SIGINT and SIGTERM interrupt the testbed. The next such signal ends the process.
void take_interrupts();

/// Waits until `holds` returns true, at most `seconds` or until the testbed is interrupted. It
/// calls `holds` every few milliseconds. Returns the last result.
template <class F>
bool wait_until(double seconds, F&& holds);
/// Sleeps. Returns false if the testbed was interrupted.
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
