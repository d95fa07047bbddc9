// `runstone-bench chunk-edge`: the costs and savings of each edge of world chunks. The same voxels
// of each landscape are cut into chunks of each edge. This table decides the default edge.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// The sums over all chunks of the region, uniform ones included, at one edge.
struct ChunkEdgeRow {
  std::string world;
  unsigned edge = 0;
  std::size_t chunks = 0, uniform = 0, runs = 0, quads = 0;
  std::size_t voxels = 0;
  std::size_t run_bytes = 0;     // runs alone
  std::size_t mixed_bytes = 0;   // runs of the chunks that are not uniform
  std::size_t memory_bytes = 0;  // runs with their spare capacity and the chunk around them
  std::size_t packed_bytes = 0;  // on the wire
  double mesh_ns = 0;            // all chunks once: median over the passes
  double edit_ns = 0;            // splice and remesh of one voxel, neighbours included: median
  double edit_full_mesh_ns = 0;  // a full mesh of the edited chunks: median
};

Result<std::vector<ChunkEdgeRow>, std::string> run_chunk_edge(const BenchOptions& options,
                                                              std::ostream& progress);

void write_table(const std::vector<ChunkEdgeRow>& rows, std::ostream& out);
void write_csv(const std::vector<ChunkEdgeRow>& rows, std::ostream& out);
void write_json(const std::vector<ChunkEdgeRow>& rows, std::ostream& out);

}  // namespace runstone::bench
