// Counts of a report that come from a link to the server.
#pragma once
#include "client/report/report.hpp"
#include "client/stream/message_stream.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Adds the chunk snapshots of a message to the counts. `received` is the message's; its field
/// `message` is not read.
void count_snapshots(SnapshotStats& stats, const Chunks& chunks, const LinkReceived& received);
/// Returns the counts of a link over all of its connections.
NetCounts net_counts(const LinkStats& stats);

}  // namespace runstone
