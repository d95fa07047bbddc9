#include "server/web/metrics_text.hpp"

#include <prometheus/text_serializer.h>

#include <limits>
#include <vector>

namespace runstone {
namespace {

void add_metric(std::vector<prometheus::MetricFamily>& out, const std::string& name,
                const std::string& help, double value) {
  prometheus::ClientMetric metric;
  metric.untyped.value = value;
  out.push_back({"runstone_" + name, help, prometheus::MetricType::Untyped, {std::move(metric)}});
}

/// Adds the histogram that the counters edit_wait_* describe. A later server may have other bounds.
void add_waits(std::vector<prometheus::MetricFamily>& out, const ServerStatus& server) {
  prometheus::ClientMetric metric;
  metric.histogram.sample_count = static_cast<std::uint64_t>(server.counter("edit_wait_count"));
  metric.histogram.sample_sum = static_cast<double>(server.counter("edit_wait_us")) / 1e6;
  for (const EditWaits& waits : edit_waits(server))
    metric.histogram.bucket.push_back({waits.count, static_cast<double>(waits.ms_max) / 1e3});
  metric.histogram.bucket.push_back(
      {metric.histogram.sample_count, std::numeric_limits<double>::infinity()});
  out.push_back({"runstone_edit_wait_seconds",
                 "time from accepting an edit of a player to sending its commit",
                 prometheus::MetricType::Histogram,
                 {std::move(metric)}});
}

}  // namespace

std::string metrics_text(const ServerStatus& server, const WebCounters& web) {
  std::vector<prometheus::MetricFamily> families;
  add_metric(families, "up", "1 if the server answers the gateway", server.is_up ? 1 : 0);
  for (const auto& [name, value] : server.counters) {
    add_metric(families, name, "counter of the server with this name", static_cast<double>(value));
  }
  if (server.is_up) add_waits(families, server);
  const auto add = [&](const char* name, const char* help, std::uint64_t value) {
    add_metric(families, std::string("web_") + name, help, static_cast<double>(value));
  };
  add("connections", "connections accepted since the start", web.connections);
  add("refused", "connections closed at once because of a limit", web.refused);
  add("connections_open", "connections now", web.connections_open);
  add("requests", "requests answered since the start", web.requests);
  add("websockets", "WebSockets opened since the start", web.websockets);
  add("websockets_open", "WebSockets now", web.websockets_open);
  add("rules_broken", "WebSockets closed because of what they sent", web.rules_broken);
  add("frames_in", "frames from browsers", web.frames_in);
  add("frames_out", "frames to browsers", web.frames_out);
  add("bytes_in", "bytes of frames from browsers", web.bytes_in);
  add("bytes_out", "bytes of frames to browsers", web.bytes_out);
  add("map_requests", "requests that the map answered", web.map_requests);
  add("map_refused", "requests for the map refused because of a limit", web.map_refused);
  add("map_not_modified", "pictures that the browser had", web.map_not_modified);
  add("map_work_us", "microseconds of drawing", web.map_work_us);
  add("memory_bytes", "memory of the gateway in RAM", web.memory_bytes);
  add("map_cache_bytes", "memory of what the map has drawn", web.map_cache_bytes);
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace runstone
