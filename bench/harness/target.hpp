// Target: a value that a figure must reach, and whether it did.
#pragma once
#include <iosfwd>
#include <span>
#include <string>

namespace runstone::bench {

enum class Verdict { met, missed, not_measured };

struct Target {
  std::string what, wanted, measured;
  Verdict verdict = Verdict::not_measured;
};

/// Prints a table of Markdown.
void write_targets(std::span<const Target> targets, std::ostream& out);

const char* name_of(Verdict verdict);

}  // namespace runstone::bench
