// Figure: one number that the lab measured, in the form of its CSV and JSON files.
#pragma once
#include <iosfwd>
#include <span>
#include <string>

#include "tests/bench/harness/machine.hpp"
#include "tests/bench/harness/target.hpp"

namespace runstone::bench {

struct Figure {
  std::string experiment, profile, link;
  std::string what;  // which case of the experiment: "idle", "luanti packed"
  std::string name;  // with its unit: "remote_meshed_p99_ms"
  double value = 0;  // infinite: never
};

/// One line of names, then one a figure. Infinite is "inf".
void write_csv(std::span<const Figure> figures, std::ostream& out);
/// {machine, figures, bars}. Infinite is "inf".
void write_json(const Machine& machine, std::span<const Figure> figures,
                std::span<const Target> targets, std::ostream& out);

/// Milliseconds and other numbers for tables: "12.3", "0.45", "inf".
std::string number_text(double value);

}  // namespace runstone::bench
