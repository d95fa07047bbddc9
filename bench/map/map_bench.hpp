// `runstone-bench map`: how long the map of the gateway takes. It makes a world of stored chunks
// with a log, and imports a Luanti world. It draws tiles of the present and of random moments with
// empty caches, and the whole Luanti world at all zooms.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "bench/harness/machine.hpp"
#include "bench/harness/target.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// Times of tiles of one sort, each drawn with empty caches.
struct MapTimes {
  std::string what;
  std::size_t tiles = 0;
  double median_ms = 0, slowest_ms = 0;
  double cpu_ms = 0;  // median of the thread's processor time: other programs do not count
  double bytes = 0;   // of a picture, mean
};

struct MapResult {
  Machine machine;
  unsigned repetitions = 0;
  std::uint64_t edits = 0;   // of the log
  std::uint64_t chunks = 0;  // stored
  std::vector<MapTimes> times;
  // The whole Luanti world at all zooms, from opening the folder on, with empty caches.
  std::size_t whole_tiles = 0;
  double whole_ms = 0, whole_cpu_ms = 0;
  std::uint64_t writes =
      0;  // drawings of the whole world after which a file of its folder differed
  std::vector<Target> targets() const;
};

/// Single-threaded. Fails if the Luanti world cannot be read.
Result<MapResult, std::string> run_map_bench(const BenchOptions& options, std::ostream& progress);

void write_table(const MapResult& result, std::ostream& out);
void write_json(const MapResult& result, std::ostream& out);

}  // namespace runstone::bench
