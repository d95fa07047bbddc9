// ProgressBar: the progress of a long run: on a terminal one line that is drawn again, elsewhere a
// line for each step.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>

namespace runstone::bench {

class ProgressBar {
 public:
  /// `expected_seconds` is the sum over all steps, from which the bar estimates the remaining time.
  ProgressBar(std::ostream& out, bool is_terminal, std::size_t steps, double expected_seconds);

  void begin(const std::string& step);
  /// Ends the present step, with its expected and its real time (0: its result existed already).
  void end(const std::string& how, double expected_seconds, double took_seconds);

 private:
  void draw(const std::string& what) const;
  std::string left() const;

  std::ostream& out_;
  const bool is_terminal_;
  const std::size_t steps_;
  std::size_t done_ = 0;
  double expected_left_;
  double expected_done_ = 0, took_ = 0;  // of the steps measured in this run
  std::string step_;
};

/// Returns "45 s", "3 min", "1 h 20 min".
std::string duration_text(double seconds);

}  // namespace runstone::bench
