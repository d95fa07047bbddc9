// The page of a report: one HTML file without further files, and the tables of its figures beside
// it.
#pragma once
#include <cstddef>
#include <string>

#include "common/core/result.hpp"
#include "tests/bench/report/findings.hpp"
#include "tests/bench/report/report_options.hpp"

namespace runstone::bench {

struct WrittenPage {
  std::string file;
  std::size_t figures = 0, missing = 0;  // missing: no step of the figure was measured
};

/// Writes OUT/index.html, OUT/summary.md and OUT/csv/ from OUT/data. The figures name what is
/// missing, broken, or from another machine or commit. The error names the file that could not be
/// written.
Result<WrittenPage, std::string> write_page(const ReportOptions& options,
                                            const StepFailures& failures);

}  // namespace runstone::bench
