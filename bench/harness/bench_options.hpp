// BenchOptions: the options of a benchmark of meshers, edits, the log, bytes or storage. Each
// benchmark reads those that its subcommand has.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace runstone::bench {

struct BenchOptions {
  std::vector<std::string> worlds;                      // empty: all
  std::vector<std::string> parts;                       // volumes by name; empty: all
  std::vector<std::string> meshers;                     // names of mesher cases; empty: all
  std::vector<unsigned> edges;                          // sides of the volumes, in voxels
  std::vector<std::string> orders = {"best", "worst"};  // or "all"
  std::string luanti;                                   // folder of a Luanti world
  std::string csv, json;                                // files to write; empty: none
  unsigned repetitions = 30;
  std::size_t edits = 200'000;         // length of the log
  std::size_t clients = 1'000;         // receivers of a commit
  std::vector<std::size_t> triangles;  // of the meshes that become voxels
  std::string postgres;                // address of a PostgreSQL database
};

}  // namespace runstone::bench
