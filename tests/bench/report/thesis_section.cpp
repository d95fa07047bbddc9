#include "tests/bench/report/report_figure.hpp"
#include "tests/bench/report/thesis_figures.hpp"

namespace runstone::bench {

ReportSection thesis_section(const Evidence& evidence) {
  const ThesisFigures figures(evidence);
  ReportSection out;
  out.title = "The thesis' figures, again";
  out.introduction =
      "The 37 scenarios of the thesis, every one of their 27 chunks of 32³ with edges of other "
      "lengths where the figure says so. Its own figures are hatched, dashed or hollow.";
  out.figures.push_back(figures.efficiency());
  for (const unsigned group : {1U, 2U, 3U}) out.figures.push_back(figures.memory(group));
  for (const unsigned group : {1U, 2U, 3U}) out.figures.push_back(figures.vertices(group));
  for (const unsigned group : {1U, 2U, 3U}) out.figures.push_back(figures.phases(group));
  for (const unsigned group : {2U, 3U}) out.figures.push_back(figures.timing(group));
  for (const unsigned scenario : {1U, 5U, 17U})
    out.figures.push_back(figures.chunk_sizes(scenario));
  return out;
}

}  // namespace runstone::bench
