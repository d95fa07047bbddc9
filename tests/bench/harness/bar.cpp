#include "tests/bench/harness/bar.hpp"

#include <fmt/ostream.h>

namespace runstone::bench {

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::met:
      return "met";
    case Verdict::missed:
      return "missed";
    case Verdict::not_measured:
      return "not measured";
  }
  return "";
}

void write_bars(std::span<const Bar> bars, std::ostream& out) {
  fmt::print(out, "| case | bar | measured | |\n|---|---|---|---|\n");
  for (const Bar& bar : bars) {
    fmt::print(out, "| {} | {} | {} | {} |\n", bar.what, bar.wanted, bar.measured, name_of(bar.verdict));
  }
}

}  // namespace runstone::bench
