// How a fleet's report shows what passed its links, by kind of message.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "protocol/codec/message_traffic.hpp"

namespace runstone {

/// What a fleet received and sent, over all its connections from start to end.
struct FleetTraffic {
  Traffic received{}, sent{};
  void add(const FleetTraffic& other);
};

/// {"received": {"by_kind": {"Commit": {"messages", "bytes", "frames"}, ...}, "by_class": {"control": {...}, ...}}, "sent": ...}:
/// bytes without frame headers, kFrameHeaderBytes each; kinds that did not pass are left out.
nlohmann::ordered_json traffic_json(const FleetTraffic& traffic);
/// The same as a table: a row for each kind that passed, the most bytes first, then one for each class.
std::string traffic_table(const FleetTraffic& traffic);

}  // namespace runstone
