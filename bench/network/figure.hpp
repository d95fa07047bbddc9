// Figure: one number that the testbed measured, as in its CSV and JSON files.
#pragma once
#include <iosfwd>
#include <span>
#include <string>

#include "bench/harness/machine.hpp"
#include "bench/harness/target.hpp"

namespace runstone::bench {

struct Figure {
  std::string experiment, profile, link;
  std::string what;  // case of the experiment: "idle", "luanti packed"
  std::string name;  // includes the unit: "remote_meshed_p99_ms"
  double value = 0;  // infinite if it never happened
};

/// Writes a line of names, then a line for each figure. Infinite is "inf".
void write_csv(std::span<const Figure> figures, std::ostream& out);
/// Writes {machine, figures, bars}. Infinite is "inf".
void write_json(const Machine& machine, std::span<const Figure> figures,
                std::span<const Target> targets, std::ostream& out);

/// Returns a number for tables: "12.3", "0.45", "inf".
std::string number_text(double value);

}  // namespace runstone::bench
