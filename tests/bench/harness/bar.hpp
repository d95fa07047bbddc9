// Bar: what a figure has to reach, and whether it did.
#pragma once
#include <iosfwd>
#include <span>
#include <string>

namespace runstone::bench {

enum class Verdict { met, missed, not_measured };

struct Bar {
  std::string what, wanted, measured;
  Verdict verdict = Verdict::not_measured;
};

/// A table of Markdown.
void write_bars(std::span<const Bar> bars, std::ostream& out);

const char* name_of(Verdict verdict);

}  // namespace runstone::bench
