// `runstone-bench tiles`: levels of detail of whole worlds. It makes all tiles of levels 1 to 4
// from the chunks of a world, as a server does, and measures runs, bytes and times. A world with
// borders is measured once more as if it were repeated sideways without end, by runs and bytes.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/target.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// One level of one world. Level 0 are its chunks, which are not made. Chunks and tiles without
/// voxels are left out. Times are sums over the tiles, each with its median over the passes; 0
/// means that it was not measured.
struct TilesRow {
  std::string world;
  unsigned edge = 0;
  unsigned level = 0;
  std::size_t columns = 0;  // columns of voxels at level 0 that the tiles cover together
  std::size_t tiles = 0, uniform = 0;
  std::size_t runs = 0, veiled_runs = 0;
  std::size_t bytes = 0, veiled_bytes = 0;  // packed; the first are those on disk
  std::size_t coded_bytes = 0;              // of the veiled tiles, as servers send them
  std::size_t quads = 0;                    // without neighbours
  double make_us = 0;                       // from the children in their own axis orders
  double make_one_order_us = 0;  // from the same children, reordered before the time starts
  double veil_us = 0;
  double decode_stored_us = 0;  // of the packed bytes without a veil
  double decode_us = 0;         // of the packed bytes with a veil
  double decode_coded_us = 0;   // of the coded ones
  double mesh_us = 0;           // without neighbours
  /// The time to decode the children of these tiles: decode_stored_us of the level below.
  double decode_children_us = 0;
};

struct TilesResult {
  Machine machine;
  unsigned repetitions = 0;
  std::vector<TilesRow> rows;  // of a world and edge, levels ascend
  std::vector<Target> targets() const;
};

/// Single-threaded. Fails if the Luanti world is wanted and cannot be read.
Result<TilesResult, std::string> run_tiles_bench(const BenchOptions& options,
                                                 std::ostream& progress);

void write_table(const TilesResult& result, std::ostream& out);
void write_json(const TilesResult& result, std::ostream& out);

}  // namespace runstone::bench
