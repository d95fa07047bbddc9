// StorageResult: everything that `runstone-bench storage` measures, a row for each store on each
// volume, as CSV, JSON and tables of Markdown.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/machine.hpp"

namespace runstone::bench {

struct StorageRow {
  std::string world;
  std::string part;  // name of the volume in the world
  unsigned edge = 0;
  std::string store;
  std::size_t runs = 0;   // of the volume in its best order
  std::size_t bytes = 0;  // all that the store keeps
  // Medians over the repetitions.
  double build_ns = 0;      // from runs
  double read_ns = 0;       // a voxel, at random
  double walk_ns = 0;       // a voxel, all of them in turn
  double edit_ns = 0;       // one voxel set
  double brush_ns = 0;      // one ball painted
  double brush_voxels = 0;  // of a ball, inside the volume: mean

  double bytes_per_voxel() const {
    return static_cast<double>(bytes) / (double{1} * edge * edge * edge);
  }
  double brush_ns_per_voxel() const { return brush_ns / brush_voxels; }
};

struct StorageResult {
  Machine machine;
  unsigned repetitions = 0;
  std::string morton_code;  // how codes are made: "pdep" or "table"
  std::vector<StorageRow> rows;
  std::vector<std::string> skipped;  // cells that were not measured, each with the reason
};

/// Writes a line of names, then a line for each row. Times are in ns.
void write_csv(const StorageResult& result, std::ostream& out);
void write_json(const StorageResult& result, std::ostream& out);

/// Prints a table for each group of worlds (landscapes, patterns, luanti, scenarios) and edge:
/// geometric means over its volumes.
void write_tables(const StorageResult& result, std::ostream& out);

}  // namespace runstone::bench
