// Report: what a client measured, as JSON and as a table for people.
#pragma once
#include <cstdint>
#include <string>

#include "client/cache/chunk_cache.hpp"
#include "client/replica/client_session.hpp"
#include "client/schedule/histogram.hpp"
#include "client/schedule/join_recorder.hpp"
#include "client/schedule/latency_recorder.hpp"

namespace runstone {

/// Chunks as they came and were meshed.
struct ChunkStats {
  std::uint64_t snapshots = 0;
  std::uint64_t wire_bytes = 0;  // messages, frame headers not counted
  std::uint64_t raw_bytes = 0;   // the same chunks in the raw encoding
  Histogram runs;                // per snapshot
  Histogram unpack_ns;           // per snapshot: verify, decode, validate
  Histogram whole_ns;            // per mesh of a whole chunk
  Histogram layers_ns;           // per mesh of what changed since the one before
  std::uint64_t mesh_jobs = 0, chunks_meshed = 0;
  std::uint64_t kept_mesh_bytes = 0;  // of the newest meshes of all chunks in view, at the end
};

/// Frames as they were drawn, on the draw thread.
struct FrameStats {
  std::uint64_t presented = 0;
  Histogram draw_us;  // per frame: from its start until it is done (LatencyStage::presented)
};

struct NetCounts {
  std::uint64_t bytes_received = 0, bytes_sent = 0;
  std::uint64_t control_bytes = 0, edit_bytes = 0, chunk_bytes = 0;  // messages received, by class
  std::uint64_t messages_received = 0, connections = 0;
};

struct ClientReport {
  std::string renderer;  // "none" or the context's name
  double seconds = 0;
  LatencyReport latency;
  JoinReport join;
  ChunkStats chunks;
  FrameStats frames;
  NetCounts net;
  std::optional<CacheCounters> cache;  // nothing without one
};

/// Durations in microseconds unless named otherwise; what was never seen is the string "inf".
std::string to_json(const ClientReport& report, const ClientSession& session);

/// A few lines for standard output: latency by stage, meshes per chunk, dense expansions.
std::string to_table(const ClientReport& report, const ClientSession& session);

/// {"world_id", "seq", "chunks": [{"lod", "x", "y", "z", "epoch", "seq", "digest"}]}: all confirmed chunks,
/// their digests recomputed from runs. False if the file cannot be written.
bool write_digests(const std::string& file, const ClientSession& session);

bool write_text(const std::string& file, const std::string& text);

}  // namespace runstone
