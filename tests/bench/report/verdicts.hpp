// Verdicts: the report in a minute. The thesis' two questions answered, then who wins and who loses at what.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/report_figure.hpp"

namespace runstone::bench {

struct ReportVerdict {
  std::string question, winner, loser;
  std::string figure;  // id of the one that shows it
};

struct Verdicts {
  std::string answer;  // three sentences, plain text
  std::vector<ReportVerdict> rows;
  std::vector<std::string> steps;  // that they rest on
};

/// Of what was measured: a question without its measurements has no row.
Verdicts verdicts_of(const Evidence& evidence);

}  // namespace runstone::bench
