#include "client/report/traffic_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace runstone {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::array<std::pair<FrameClass, const char*>, kFrameClassCount> kClasses = {
    {{FrameClass::control, "control"},
     {FrameClass::edits, "edits"},
     {FrameClass::chunks, "chunks"}}};

Json json_of(const KindTraffic& traffic) {
  return {{"messages", traffic.messages}, {"bytes", traffic.bytes}, {"frames", traffic.frames}};
}

Json json_of(const Traffic& traffic) {
  Json kinds = Json::object(), classes = Json::object();
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    if (traffic[kind].messages != 0) kinds[info_of(kind).name] = json_of(traffic[kind]);
  }
  for (const auto& [frame_class, name] : kClasses)
    classes[name] = json_of(of_class(traffic, frame_class));
  return {{"by_kind", std::move(kinds)}, {"by_class", std::move(classes)}};
}

std::string row(const char* direction, const char* name, const KindTraffic& traffic) {
  return fmt::format("{:<9} {:<18} {:>9} {:>12} {:>9} {:>10.1f}\n", direction, name,
                     traffic.messages, traffic.bytes, traffic.frames,
                     traffic.messages == 0 ? 0.0
                                           : static_cast<double>(traffic.bytes) /
                                                 static_cast<double>(traffic.messages));
}

void add_rows(const char* direction, const Traffic& traffic, std::string& out) {
  std::vector<MessageKind> kinds;
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    if (traffic[kind].messages != 0) kinds.push_back(kind);
  }
  std::sort(kinds.begin(), kinds.end(), [&](MessageKind a, MessageKind b) {
    return traffic[a].bytes != traffic[b].bytes ? traffic[a].bytes > traffic[b].bytes : a < b;
  });
  for (const MessageKind kind : kinds) out += row(direction, info_of(kind).name, traffic[kind]);
  for (const auto& [frame_class, name] : kClasses) {
    const KindTraffic sum = of_class(traffic, frame_class);
    if (sum.messages != 0) out += row(direction, fmt::format("= class {}", name).c_str(), sum);
  }
}

}  // namespace

void FleetTraffic::add(const FleetTraffic& other) {
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    received[kind] += other.received[kind];
    sent[kind] += other.sent[kind];
  }
}

Json traffic_json(const FleetTraffic& traffic) {
  return {{"received", json_of(traffic.received)}, {"sent", json_of(traffic.sent)}};
}

std::string traffic_table(const FleetTraffic& traffic) {
  std::string out = fmt::format("{:<9} {:<18} {:>9} {:>12} {:>9} {:>10}\n", "", "message",
                                "messages", "bytes", "frames", "bytes each");
  add_rows("received", traffic.received, out);
  add_rows("sent", traffic.sent, out);
  return out;
}

}  // namespace runstone
