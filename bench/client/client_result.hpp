// ClientBenchResult: everything that `runstone-bench client` measures, as JSON and as tables of
// Markdown.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/machine.hpp"
#include "bench/harness/target.hpp"

namespace runstone::bench {

/// Bursts of edits of others that arrive between two frames. *Added* work is what delays a frame:
/// meshing on the main thread before its order, and uploads on the draw thread. The light and the
/// shadows that the edits change are made while a frame is drawn: they are in `slowest_ms` alone.
struct BurstRow {
  std::string budget;  // "4 ms" or "none"
  unsigned edits = 0, bursts = 0;
  double worst_added_ms = 0;                      // of any frame
  double worst_mesh_ms = 0, worst_upload_ms = 0;  // of any frame, each alone
  double total_ms = 0;                            // added work of a burst; the mean
  std::size_t frames_min = 0, frames_max = 0;     // until all edits of a burst were presented
  std::size_t carried_max = 0;                    // uploads that a frame left for later ones
  double still_ms = 0;                            // the median frame without a burst
  /// The slowest of the frames of a burst and of those after it until light and shadows are
  /// settled, all its work included, and the slowest of about as many frames without a burst.
  /// Medians over the bursts.
  double slowest_ms = 0, still_slowest_ms = 0;
};

struct OwnEditRow {
  unsigned edits = 0;
  std::size_t frames_max =
      0;  // from the edit to the first frame whose pixels differ, that included
  double frames_mean = 0;
};

/// One way to draw the same view.
struct EffectsRow {
  std::string world, mesher, quality;
  std::size_t quads_drawn = 0;
  unsigned frames = 0;
  double p50_ms = 0, p90_ms = 0;
};

struct ClientBenchResult {
  Machine machine;
  std::string gl_renderer, gl_context;
  int width = 0, height = 0;
  std::vector<BurstRow> bursts;
  OwnEditRow own_edit;
  std::vector<EffectsRow> effects;

  std::vector<Target> targets() const;
};

void write_json(const ClientBenchResult& result, std::ostream& out);
void write_tables(const ClientBenchResult& result, std::ostream& out);

}  // namespace runstone::bench
