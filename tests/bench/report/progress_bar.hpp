// ProgressBar: how far a long run is. On a terminal one line that is drawn again, elsewhere a line a step.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>

namespace runstone::bench {

class ProgressBar {
 public:
  /// `expected_seconds` of all steps, of which the bar makes its guess of what is left.
  ProgressBar(std::ostream& out, bool is_terminal, std::size_t steps, double expected_seconds);

  void begin(const std::string& step);
  /// The step at hand ended; it was expected to take so long, and took so long (0: it was there already).
  void end(const std::string& how, double expected_seconds, double took_seconds);

 private:
  void draw(const std::string& what) const;
  std::string left() const;

  std::ostream& out_;
  const bool is_terminal_;
  const std::size_t steps_;
  std::size_t done_ = 0;
  double expected_left_;
  double expected_done_ = 0, took_ = 0;  // of the steps that were measured in this run
  std::string step_;
};

/// "45 s", "3 min", "1 h 20 min".
std::string duration_text(double seconds);

}  // namespace runstone::bench
