// `runstone-bench report`: everything measured, one page.
#pragma once
#include <iosfwd>

#include "tests/bench/report/report_options.hpp"

namespace runstone::bench {

/// Measures what is missing, each step into a file of its own, and makes the page anew after each. A step that fails is
/// named at the end and on the page, and does not keep the others from running. Returns the exit code: 1 if a
/// step failed or a file could not be written, or if it was interrupted.
int run_report(const ReportOptions& options, std::ostream& out, std::ostream& err);

}  // namespace runstone::bench
