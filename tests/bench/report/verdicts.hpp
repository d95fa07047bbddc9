// Verdicts: the short form of the report. It answers the thesis' two questions and names the winner
// and the loser of each comparison.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/report_figure.hpp"

namespace runstone::bench {

struct ReportVerdict {
  std::string question, winner, loser;
  std::string figure;  // id of the figure that shows it
};

struct Verdicts {
  std::string answer;  // three sentences, plain text
  std::vector<ReportVerdict> rows;
  std::vector<std::string> steps;  // the steps on which the answer depends
};

/// Returns the verdicts from the measurements. A question without measurements has no row.
Verdicts verdicts_of(const Evidence& evidence);

}  // namespace runstone::bench
