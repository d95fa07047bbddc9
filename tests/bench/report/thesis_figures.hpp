// ThesisFigures: the thesis' figures, drawn again from its results and from the measurements of
// this machine.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/report/report_figure.hpp"

namespace runstone::bench {

class ThesisFigures {
 public:
  /// `evidence` must outlive the object.
  explicit ThesisFigures(const Evidence& evidence);

  // Figures of one group of scenarios, 1 to 3.
  ReportFigure memory(unsigned group) const;
  ReportFigure vertices(unsigned group) const;
  ReportFigure phases(unsigned group) const;
  ReportFigure timing(unsigned group) const;
  /// Returns the figure of a chunk's time by its edge. Requires scenario 1, 5 or 17.
  ReportFigure chunk_sizes(unsigned scenario) const;
  /// Returns the figure of time against vertices, over all scenarios.
  ReportFigure efficiency() const;

 private:
  /// Returns a counted property of a scenario, such as "voxels".
  double fact(unsigned scenario, const std::string& column) const;
  /// Returns a measured value of a mesher on a scenario, such as "mean_ns".
  double time(unsigned scenario, std::string_view mesher, const std::string& column) const;
  /// Returns the thesis' mean over the 27 chunks. Voxel Plugin logs no line for a chunk without
  /// faces.
  double thesis_vertices(unsigned scenario, std::string_view mesher) const;
  /// Returns a sentence with the number of scenarios in which each rebuilt mesher has the thesis'
  /// mean of vertices.
  std::string agreement(const std::vector<unsigned>& scenarios) const;

  const ThesisData& thesis_;
  const Rows facts_, times_;
  const Findings& findings_;
};

/// A mesher of the thesis, and the mesher that was rebuilt from its description.
struct RebuiltMesher {
  const char* thesis;       // name in the thesis' results
  const char* thesis_name;  // name on the page
  const char* rebuilt;      // mesher case
  const char* rebuilt_name;
};
inline constexpr std::array<RebuiltMesher, 3> kRebuiltMeshers = {
    {{"Grid", "thesis: Grid RDM", "grid_rdm", "rebuilt Grid RDM"},
     {"RLE", "thesis: RLE RDM", "rle_rdm", "rebuilt RLE RDM"},
     {"VoxelPlugin", "thesis: Voxel Plugin", "culled", "rebuilt culled mesher over an octree"}}};

/// Calls `value` for each scenario and returns the results.
template <class Value>
std::vector<double> for_each_scenario(const std::vector<unsigned>& scenarios, Value&& value) {
  std::vector<double> out;
  for (const unsigned scenario : scenarios) out.push_back(value(scenario));
  return out;
}

}  // namespace runstone::bench
