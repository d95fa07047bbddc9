#include "bench/harness/target.hpp"

#include <fmt/ostream.h>

#include <utility>

namespace runstone::bench {

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::met:
      return "met";
    case Verdict::missed:
      return "missed";
    case Verdict::not_measured:
      return "not measured";
    case Verdict::no_target:
      return "no target";
  }
  return "";
}

Target without_target(std::string what, std::string measured) {
  return {std::move(what), "–", std::move(measured), Verdict::no_target};
}

void write_targets(std::span<const Target> targets, std::ostream& out) {
  fmt::print(out, "| case | target | measured | |\n|---|---|---|---|\n");
  for (const Target& target : targets) {
    fmt::print(out, "| {} | {} | {} | {} |\n", target.what, target.wanted, target.measured,
               name_of(target.verdict));
  }
}

}  // namespace runstone::bench
