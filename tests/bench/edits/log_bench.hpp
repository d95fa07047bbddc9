// What a long log costs: questions to it, keyframes, opening the world at moments of it, previews of a rollback.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "tests/bench/app/bench_options.hpp"

namespace runstone::bench {

struct LogQuestion {
  std::string name;
  double found = 0;  // edits, mean
  double median_ms = 0, slowest_ms = 0;
};

/// Of opening the world at a moment with so many keyframes (0: from the base), and then making chunks.
struct LogMoments {
  std::size_t keyframes = 0, moments = 0;
  double edits_read = 0, chunks = 0;  // mean, of a moment: read since its keyframe; edited up to it
  double open_ms = 0, open_slowest_ms = 0;
  double view_ms = 0,
         view_slowest_ms = 0;             // opening, and the chunks around the last edit, radius 8
  double all_ms = 0, all_slowest_ms = 0;  // opening, and all edited chunks
};

/// Of the preview of a rollback: one author's last hour, planned with the keyframes there are, without a picture.
struct LogPreview {
  std::uint64_t edits = 0, chunks = 0, voxels = 0;  // selected, touched, that would change
  double select_ms = 0, select_slowest_ms = 0;
  double plan_ms = 0, plan_slowest_ms = 0;
};

struct LogBench {
  std::uint64_t edits = 0;
  double append_us = 0;          // an edit, 64 a commit, fsync off
  double bytes = 0;              // of database an edit, before keyframes
  double keyframe_bytes = 0;     // an edit, that keyframes add
  double keyframes_seconds = 0;  // making all of them
  std::uint64_t keyframe_chunks = 0;
  std::vector<LogQuestion> questions;
  std::vector<LogMoments> moments;
  LogPreview preview;
};

/// A world of options.edits edits of eight builders over terrain (synthetic: tests/support/builder_session.hpp), in a folder that
/// is gone afterwards. options.repetitions questions of each sort, spread over the log, and as many moments at random,
/// and as many previews, which are alike.
Result<LogBench, std::string> run_log_bench(const BenchOptions& options, std::ostream& progress);

void write_table(const LogBench& bench, std::ostream& out);
void write_json(const LogBench& bench, std::ostream& out);

}  // namespace runstone::bench
