// Target: a figure, the value that it must reach, if there is one, and whether it did.
#pragma once
#include <iosfwd>
#include <span>
#include <string>

namespace runstone::bench {

enum class Verdict {
  met,
  missed,
  not_measured,
  no_target,  // docs/performance.md says what bounds the figure
};

struct Target {
  std::string what, wanted, measured;
  Verdict verdict = Verdict::not_measured;
};

/// Returns a figure without a target.
Target without_target(std::string what, std::string measured);

/// Prints a table of Markdown.
void write_targets(std::span<const Target> targets, std::ostream& out);

const char* name_of(Verdict verdict);

}  // namespace runstone::bench
