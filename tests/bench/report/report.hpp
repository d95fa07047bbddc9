// `runstone-bench report`: measures everything and makes one page.
#pragma once
#include <iosfwd>

#include "tests/bench/report/report_options.hpp"

namespace runstone::bench {

/// Measures what is missing, each step into a file of its own, and writes the page after each. A
/// failed step is named at the end and on the page; the others still run. Returns the exit code: 1
/// if a step failed, if a file could not be written, or if the run was interrupted.
int run_report(const ReportOptions& options, std::ostream& out, std::ostream& err);

}  // namespace runstone::bench
