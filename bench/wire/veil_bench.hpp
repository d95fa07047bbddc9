// `runstone-bench veil`: the chunks of whole worlds with and without a veil: runs, bytes, and the
// times to make the veil, to find the voxels that one dug voxel uncovers, to unpack and to mesh. A
// pass handles all chunks of a world in turn, so caches and branch predictors are as cold as in a
// client.
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

/// The chunks of a world in one form. Means of a chunk; a chunk's time is its median over the
/// passes.
struct VeilWay {
  double runs = 0;
  double bytes = 0;  // packed
  double unpack_us = 0;
  double mesh_us = 0;  // with the borders that earlier meshes left
  double quads = 0;
  double both_us() const { return unpack_us + mesh_us; }
};

struct VeilRow {
  std::string world;
  unsigned edge = 0;
  std::size_t chunks = 0;  // not uniform without a veil
  VeilWay plain;           // each chunk in its cheapest axis order
  VeilWay veiled;          // in kVeilOrder
  VeilWay turned;          // veiled, then in its cheapest axis order
  double veil_us = 0;      // to make a veiled chunk from the plain one
  double uncover_us = 0;   // to find what one dug voxel uncovers
};

struct VeilResult {
  Machine machine;
  unsigned repetitions = 0;
  std::vector<VeilRow> rows;
  std::vector<Target> targets() const;
};

/// Thread: one. Fails if the Luanti world is wanted and cannot be read.
Result<VeilResult, std::string> run_veil_bench(const BenchOptions& options, std::ostream& progress);

void write_table(const VeilResult& result, std::ostream& out);
void write_json(const VeilResult& result, std::ostream& out);

}  // namespace runstone::bench
