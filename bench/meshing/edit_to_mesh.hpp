// `runstone-bench edit-to-mesh`: edits by brush, from the edit to the mesh of the chunk. The time to
// mesh the layers that an edit touched is compared with the time to mesh the whole chunk.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/target.hpp"
#include "bench/meshing/brush_case.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// One brush on the volumes of one world at one edge. Times are medians over the edits of a volume,
/// and medians of these over the volumes.
struct EditToMeshRow {
  std::string world, brush;
  unsigned edge = 0;
  bool alone = false;  // true: meshed without the neighbours
  std::size_t volumes = 0;
  BrushTiming timing;
  /// Returns the time for layers divided by the time of mesh_rdm() in this build.
  double ratio() const { return timing.layers_ns / timing.whole_ns; }
};

struct EditToMeshResult {
  Machine machine;
  std::vector<EditToMeshRow> rows;
  std::vector<Target> targets;
};

/// Fails if a world cannot be read.
Result<EditToMeshResult, std::string> run_edit_to_mesh(const BenchOptions& options,
                                                       std::ostream& progress);

void write_table(const EditToMeshResult& result, std::ostream& out);
void write_csv(const EditToMeshResult& result, std::ostream& out);
void write_json(const EditToMeshResult& result, std::ostream& out);

}  // namespace runstone::bench
