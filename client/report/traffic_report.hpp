// The traffic of a fleet's links, by kind and class of message, as JSON and as a table.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "protocol/codec/message_traffic.hpp"

namespace runstone {

/// The messages that a fleet received and sent, over all connections from start to end.
struct FleetTraffic {
  Traffic received{}, sent{};
  void add(const FleetTraffic& other);
};

/// Returns {"received": {"by_kind": {"Commit": {"messages", "bytes", "frames"}, ...}, "by_class":
/// {"control": {...}, ...}}, "sent": ...}. Bytes do not include frame headers, which have
/// kFrameHeaderBytes each. Kinds without messages are left out.
nlohmann::ordered_json traffic_json(const FleetTraffic& traffic);
/// Returns a table with a row for each kind that has messages, most bytes first, and a row for each
/// class.
std::string traffic_table(const FleetTraffic& traffic);

}  // namespace runstone
