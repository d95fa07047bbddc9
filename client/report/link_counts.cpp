#include "client/report/link_counts.hpp"

namespace runstone {

void count_snapshots(SnapshotStats& stats, const Chunks& chunks, const LinkReceived& received) {
  const auto entries = static_cast<std::int64_t>(chunks.chunks.size());
  const std::uint64_t count_before = stats.count;
  for (const ChunkAnswer& answer : chunks.chunks) {
    const auto* snapshot = std::get_if<ChunkSnapshot>(&answer);
    if (snapshot == nullptr) continue;
    ++stats.count;
    stats.raw_bytes += raw_bytes(snapshot->chunk.voxels);
    stats.runs.add(static_cast<std::int64_t>(snapshot->chunk.voxels.runs.size()));
    stats.unpack_ns.add(received.unpack_ns / entries);
  }
  if (stats.count != count_before) stats.wire_bytes += received.bytes;
}

NetCounts net_counts(const LinkStats& stats) {
  NetCounts out;
  out.bytes_received = stats.bytes_received;
  out.bytes_sent = stats.bytes_sent;
  const Traffic received = stats.received.read();
  out.control_bytes = of_class(received, FrameClass::control).bytes;
  out.edit_bytes = of_class(received, FrameClass::edits).bytes;
  out.chunk_bytes = of_class(received, FrameClass::chunks).bytes;
  for (const KindTraffic& kind : received) out.messages_received += kind.messages;
  out.connections = stats.connections;
  return out;
}

}  // namespace runstone
