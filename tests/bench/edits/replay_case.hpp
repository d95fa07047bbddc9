// Replay cases: a log of single voxels as builders make them, over chunks of generated terrain.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_record.hpp"

namespace runstone::bench {

struct ReplayTiming {
  std::size_t edits = 0, chunks = 0;
  // Edits a second, a sample per repetition.
  std::vector<double>
      from_log;  // all that runstone-replay does: read, verify, apply, compare digests at the end
  std::vector<double> apply;   // one edit after another, from memory, without generating chunks
  std::vector<double> remesh;  // the same, each followed by its dirty layers, neighbours included
};
/// Writes a world of its own below `folder` for from_log.
Result<ReplayTiming, std::string> time_replay(std::size_t edits, unsigned repetitions,
                                              const std::string& folder);

}  // namespace runstone::bench
