// Replay cases: a log of single voxels as builders set them, over chunks of generated terrain.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_record.hpp"

namespace runstone::bench {

struct ReplayTiming {
  std::size_t edits = 0, chunks = 0;
  // The samples are edits a second, one for each repetition.
  // from_log: all that runstone-replay does: read, verify, apply, and compare digests at the end.
  std::vector<double> from_log;
  // apply: one edit after another, from memory, without generating chunks.
  std::vector<double> apply;
  // remesh: as apply, with the dirty layers of each edit meshed, neighbours included.
  std::vector<double> remesh;
};

/// Measures the replay. Writes a world for from_log below `folder`.
Result<ReplayTiming, std::string> time_replay(std::size_t edits, unsigned repetitions,
                                              const std::string& folder);

}  // namespace runstone::bench
