// The costs of a long log: queries, keyframes, opening the world at moments of the past, and
// previews of a rollback.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

struct LogQuestion {
  std::string name;
  double found = 0;  // edits, mean
  double median_ms = 0, slowest_ms = 0;
};

/// The times to open the world at a moment with `keyframes` keyframes (0: from the base), and then
/// to make chunks.
struct LogMoments {
  std::size_t keyframes = 0, moments = 0;
  // Means of a moment: edits read since its keyframe; chunks edited up to it.
  double edits_read = 0, chunks = 0;
  double open_ms = 0, open_slowest_ms = 0;
  // The time to open the moment and make the chunks around the last edit (radius 8).
  double view_ms = 0, view_slowest_ms = 0;
  // The time to open the moment and make all edited chunks.
  double all_ms = 0, all_slowest_ms = 0;
};

/// The times of the preview of a rollback: all edits of one author in the last hour, with the present
/// keyframes, for somebody who sees none of the chunks, on one thread. A preview selects the edits
/// and counts the voxels that would change. To apply the rollback, all chunks are planned.
struct LogPreview {
  std::string name;
  // Selected edits, touched chunks, voxels that would change.
  std::uint64_t edits = 0, chunks = 0, voxels = 0;
  double select_ms = 0, select_slowest_ms = 0;
  double count_ms = 0, count_slowest_ms = 0;
  double preview_ms = 0, preview_slowest_ms = 0;  // both together
  double plan_ms = 0, plan_slowest_ms = 0;
};

struct LogBench {
  std::uint64_t edits = 0;
  double append_us = 0;          // of an edit, 64 a commit, fsync off
  double bytes = 0;              // of the database an edit, before keyframes
  double keyframe_bytes = 0;     // that the keyframes add an edit
  double keyframes_seconds = 0;  // to make all of them
  std::uint64_t keyframe_chunks = 0;
  std::vector<LogQuestion> questions;
  std::vector<LogMoments> moments;
  // The first preview is of a builder. The others are of griefers, who edit random places of a
  // square, which is 1,600 voxels long and wide: two set single voxels, the last one fills boxes.
  std::vector<LogPreview> previews;
};

/// Makes a world of options.edits synthetic edits of eight builders over terrain
/// (tests/support/edits/builder_session.hpp), in a folder that it removes afterwards. Makes
/// options.repetitions queries of each sort, spread over the log. Opens as many random moments, and
/// makes as many previews of equal size. Fails if a preview counts other voxels than the plans change.
Result<LogBench, std::string> run_log_bench(const BenchOptions& options, std::ostream& progress);

void write_table(const LogBench& bench, std::ostream& out);
void write_json(const LogBench& bench, std::ostream& out);

}  // namespace runstone::bench
