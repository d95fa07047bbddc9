// The page of a report: one HTML file that needs nothing else, and the tables of its figures beside it.
#pragma once
#include <cstddef>
#include <string>

#include "common/core/result.hpp"
#include "tests/bench/report/findings.hpp"
#include "tests/bench/report/report_options.hpp"

namespace runstone::bench {

struct WrittenPage {
  std::string file;
  std::size_t figures = 0, missing = 0;  // missing: nothing of what they show was measured
};

/// Makes OUT/index.html, OUT/summary.md and OUT/csv/ of what lies in OUT/data. What is missing, broken, or of another machine or commit
/// is said where it shows. The error names the file that could not be written.
Result<WrittenPage, std::string> write_page(const ReportOptions& options,
                                            const StepFailures& failures);

}  // namespace runstone::bench
