// The report as a few lines of Markdown, for a README or a note.
#pragma once
#include <string>

#include "tests/bench/report/report_figure.hpp"

namespace runstone::bench {

/// The answer, who wins at what, and a line for each mesher over the 37 scenarios. Empty if the meshers were not
/// measured.
std::string summary_of(const Evidence& evidence);

}  // namespace runstone::bench
