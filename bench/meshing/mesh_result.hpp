// MeshResult: everything that `runstone-bench mesh` measures, a row for each mesher in each cell,
// as CSV, JSON and tables of Markdown.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/machine.hpp"
#include "bench/harness/target.hpp"
#include "bench/meshing/cell.hpp"

namespace runstone::bench {

struct MeshRow {
  std::string world;
  std::string part;  // name of the volume in the world
  unsigned edge = 0;
  std::string order;  // axes, fastest first
  // "best" and "worst": the fewest and the most runs of the six orders; or "between"
  std::string rank;
  std::string mesher;
  std::size_t runs = 0;
  Timing timing;
  /// The median of decode_binary or mask_binary in the same cell, divided by this row's median.
  /// Above 1 this row is faster.
  std::optional<double> against_decode, against_mask;
  /// False if a mesher of the cell made no triangles, because the chunk has no exposed face. Such a
  /// cell is in no mean.
  bool has_faces = true;

  double ns_per_run() const { return timing.median_ns / static_cast<double>(runs); }
  std::string cell() const;  // world, part, edge and order as text
};

struct MeshResult {
  Machine machine;
  unsigned repetitions = 0;
  std::vector<MeshRow> rows;
  std::vector<std::string> skipped;  // cells that were not measured, each with the reason
  std::vector<Target> targets;
};

/// Writes a line of names, then a line for each row. Times are in ns.
void write_csv(const MeshResult& result, std::ostream& out);
void write_json(const MeshResult& result, std::ostream& out);

/// Prints a table for each world, edge and rank of order: means over its volumes with exposed
/// faces, and ratios as geometric mean and as ratio of sums.
void write_tables(const MeshResult& result, std::ostream& out);

/// Prints one table with a line of the product for each of those tables.
void write_overview(const MeshResult& result, std::ostream& out);

}  // namespace runstone::bench
