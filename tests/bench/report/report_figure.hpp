// ReportFigure: one figure of the report, with its numbers and a sentence about its content.
#pragma once
#include <string>
#include <vector>

#include "tests/bench/report/data_table.hpp"
#include "tests/bench/report/findings.hpp"
#include "tests/bench/report/thesis_data.hpp"

namespace runstone::bench {

struct ReportFigure {
  std::string id;  // anchor in the page, and name of its CSV
  std::string title;
  std::string sentence;            // what the figure shows, plain text
  std::vector<std::string> steps;  // the steps from which it is drawn
  DataTable data;
  std::string picture;                  // HTML: the chart
  std::vector<std::string> marks = {};  // known defects of data, plain text
};

struct ReportSection {
  std::string title, introduction;
  std::vector<ReportFigure> figures;
};

/// The sources of figures.
struct Evidence {
  const Findings& findings;
  const ThesisData& thesis;
};

/// Returns the thesis' figures, with our numbers beside the thesis'.
ReportSection thesis_section(const Evidence& evidence);
/// Returns the comparison of all meshers.
ReportSection field_section(const Evidence& evidence);
/// Returns the cost of drawing the meshes, and other ways to store voxels.
ReportSection drawing_section(const Evidence& evidence);
/// Returns the thesis' future work: real worlds, axis orders, dirty layers, edits.
ReportSection beyond_section(const Evidence& evidence);
/// Returns the figures of the same voxels over links: bytes, transfers, latency, fleets.
ReportSection network_section(const Evidence& evidence);

}  // namespace runstone::bench
