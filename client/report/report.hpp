// ClientReport: the measurements of a client, as JSON and as a table for people.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "client/cache/cache_counters.hpp"
#include "client/far/far_budget.hpp"
#include "client/far/horizon_recorder.hpp"
#include "client/schedule/histogram.hpp"
#include "client/schedule/join_recorder.hpp"
#include "client/schedule/latency_recorder.hpp"
#include "client/schedule/memory_budget.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

/// Chunk snapshots received.
struct SnapshotStats {
  std::uint64_t count = 0;
  std::uint64_t wire_bytes = 0;  // messages with snapshots, frame headers not counted
  std::uint64_t raw_bytes = 0;   // the same chunks in the raw encoding
  Histogram runs;                // per snapshot
  /// Per snapshot: verify, decode, validate. A message with several chunks counts in equal shares.
  Histogram unpack_ns;
};

/// Meshes made.
struct MeshStats {
  Histogram whole_ns;        // per mesh of a whole chunk
  Histogram layers_ns;       // per mesh of the layers that changed since the chunk's last mesh
  std::uint64_t jobs = 0;    // meshes of either kind
  std::uint64_t chunks = 0;  // chunks meshed at least once
  std::uint64_t kept_bytes =
      0;  // the newest meshes of all chunks in view, and kept borders, at the end
};

/// Frames drawn by the draw thread.
struct FrameStats {
  std::uint64_t presented = 0;
  Histogram draw_us;    // per frame, from its start until it was presented
  Histogram upload_us;  // per frame, what uploads took since the frame before
};

struct NetCounts {
  std::uint64_t bytes_received = 0, bytes_sent = 0;
  std::uint64_t control_bytes = 0, edit_bytes = 0, chunk_bytes = 0;  // received messages, by class
  std::uint64_t messages_received = 0, connections = 0;
};

/// The distant ground at the end.
struct FarReport {
  std::size_t tiles = 0, bytes = 0;  // held; bytes with their meshes
  std::size_t bytes_max = 0;         // of the budget
  unsigned levels = 0, wanted = 0;   // of the view; as FarBudget
  double reach = 0;                  // how far ground is seen, voxels
  HorizonReport horizon;
};

/// What MemoryBudget did.
struct BudgetReport {
  std::size_t bytes_max = 0, peak_bytes = 0;
  std::uint64_t shrinks = 0, growths = 0;  // of the view, in steps
  ViewRadii radii, wanted;                 // at the end
};

/// Returns what the budget did up to now.
BudgetReport report_of(const MemoryBudget& budget);
/// Sets the fields of the report that come from the budget of distant ground.
void set_far_budget(FarReport& report, const FarBudget& budget);

struct ClientReport {
  std::string renderer;  // name of the OpenGL context, or "none"
  double seconds = 0;
  LatencyReport latency;
  JoinReport join;
  std::uint64_t edits_refused = 0;  // local edits that this client did not accept, by EditTool
  SnapshotStats snapshots;
  MeshStats meshes;
  FrameStats frames;
  NetCounts net;
  MemoryUse memory;  // at the end
  BudgetReport budget;
  FarReport far;
  std::optional<CacheCounters> cache;  // nullopt without a cache
};

/// Durations are in microseconds where the key names no other unit. An infinite value is the string
/// "inf".
std::string to_json(const ClientReport& report, const ClientSession& session);

/// Returns the closing table for standard output: latency by stage, chunks and meshes, frames,
/// drift, dense expansions.
std::string to_table(const ClientReport& report, const ClientSession& session);

/// Writes {"world_id", "seq", "chunks": [{"lod", "x", "y", "z", "epoch", "seq", "digest"}]} with
/// all confirmed chunks, as write_output_file() does. The digests are recomputed from the runs.
Result<void, std::string> write_digests(const std::string& file, const ClientSession& session);

}  // namespace runstone
