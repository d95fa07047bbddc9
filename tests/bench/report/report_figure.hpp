// ReportFigure: one picture of the report with the numbers behind it and the sentence that says what to see.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/data_table.hpp"
#include "tests/bench/report/findings.hpp"
#include "tests/bench/report/thesis_data.hpp"

namespace runstone::bench {

struct ReportFigure {
  std::string id;  // its anchor, and the name of its CSV
  std::string title;
  std::string sentence;            // what to see, plain text
  std::vector<std::string> steps;  // it is drawn from
  DataTable data;
  std::string picture;                  // HTML: the chart
  std::vector<std::string> marks = {};  // known defects of data, plain text
};

struct ReportSection {
  std::string title, introduction;
  std::vector<ReportFigure> figures;
};

/// What figures are made from.
struct Evidence {
  const Findings& findings;
  const ThesisData& thesis;
};

/// The thesis' own figures from our numbers beside its own.
ReportSection thesis_section(const Evidence& evidence);
/// All meshers against each other.
ReportSection field_section(const Evidence& evidence);
/// What their meshes cost to draw, and other ways to keep voxels.
ReportSection drawing_section(const Evidence& evidence);
/// What the thesis left as future work: real worlds, axis orders, dirty layers, edits.
ReportSection beyond_section(const Evidence& evidence);
/// The same voxels over links: bytes, transfers, latency, crowds.
ReportSection network_section(const Evidence& evidence);

}  // namespace runstone::bench
