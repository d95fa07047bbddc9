// The report as a few lines of Markdown, for a README.
#pragma once
#include <string>

#include "tests/bench/report/report_figure.hpp"

namespace runstone::bench {

/// Returns the answer, the winners, and a line for each mesher over the 37 scenarios. Returns an
/// empty text if the meshers were not measured.
std::string summary_of(const Evidence& evidence);

}  // namespace runstone::bench
