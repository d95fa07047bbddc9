// `runstone-bench tiles`: levels of detail of whole worlds. It builds all tiles of levels 1 to 4
// from the chunks of a world, and measures runs, bytes and times. The tiles of a level are made
// from those of the level below before their veil.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "tests/bench/harness/bench_options.hpp"
#include "tests/bench/harness/machine.hpp"
#include "tests/bench/harness/target.hpp"

namespace runstone::bench {

/// One level of one world. Level 0 are its chunks, which have no build and no veil. Chunks and
/// tiles without voxels are left out. Times are sums over the tiles, each with its median over the
/// passes.
struct TilesRow {
  std::string world;
  unsigned edge = 0;
  unsigned level = 0;
  std::size_t columns = 0;  // columns of voxels at level 0 that the tiles cover together
  std::size_t tiles = 0, uniform = 0;
  std::size_t runs = 0, veiled_runs = 0;
  std::size_t bytes = 0, veiled_bytes = 0;  // packed
  std::size_t quads = 0;                    // without neighbours
  double build_us = 0;                      // from the children in their own axis orders
  double build_one_order_us = 0;  // from the same children, reordered before the time starts
  double veil_us = 0;
  double decode_us = 0;  // of the packed bytes of these tiles, veiled
  double mesh_us = 0;    // without neighbours
  /// The time to decode the children of these tiles: decode_us of the level below.
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
