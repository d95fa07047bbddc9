#include "server/web/metrics_text.hpp"

#include <prometheus/text_serializer.h>

#include <limits>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

namespace runstone {
namespace {

using Families = std::map<std::string, prometheus::MetricFamily>;

/// Adds a value to the family of its name. `world`: the label of one of several worlds, or empty.
void add_metric(Families& out, const std::string& name, const std::string& help,
                prometheus::MetricType type, prometheus::ClientMetric metric,
                std::string_view world) {
  if (!world.empty()) metric.label.push_back({"world", std::string(world)});
  prometheus::MetricFamily& family = out[name];
  family.name = "runstone_" + name;
  family.help = help;
  family.type = type;
  family.metric.push_back(std::move(metric));
}

void add_number(Families& out, const std::string& name, const std::string& help, double value,
                std::string_view world = {}) {
  prometheus::ClientMetric metric;
  metric.untyped.value = value;
  add_metric(out, name, help, prometheus::MetricType::Untyped, std::move(metric), world);
}

std::string help_of(const std::string& counter) {
  if (counter == "row_faults")
    return "damaged rows of the world that the check has found. If it is not 0, the log of the "
           "server names them: stop the server and run runstone-server repair";
  if (counter == "chunks_failed")
    return "chunks that could not be read. The log of the server names them";
  return "counter of the server with this name";
}

/// Adds the histogram that the counters edit_wait_* describe. A later server may have other bounds.
void add_waits(Families& out, const ServerStatus& server, std::string_view world) {
  prometheus::ClientMetric metric;
  metric.histogram.sample_count = static_cast<std::uint64_t>(server.counter("edit_wait_count"));
  metric.histogram.sample_sum = static_cast<double>(server.counter("edit_wait_us")) / 1e6;
  for (const EditWaits& waits : edit_waits(server))
    metric.histogram.bucket.push_back({waits.count, static_cast<double>(waits.ms_max) / 1e3});
  metric.histogram.bucket.push_back(
      {metric.histogram.sample_count, std::numeric_limits<double>::infinity()});
  add_metric(out, "edit_wait_seconds",
             "time from accepting an edit of a player to sending its commit",
             prometheus::MetricType::Histogram, std::move(metric), world);
}

}  // namespace

std::string metrics_text(std::span<const WorldStatus> worlds, const WebCounters& web) {
  Families families;
  for (const WorldStatus& world : worlds) {
    const ServerStatus& server = *world.status;
    add_number(families, "up", "1 if the server answers the gateway", server.is_up ? 1 : 0,
               world.name);
    for (const auto& [name, value] : server.counters) {
      add_number(families, name, help_of(name), static_cast<double>(value), world.name);
    }
    if (server.is_up) add_waits(families, server, world.name);
  }
  const auto add = [&](const char* name, const char* help, std::uint64_t value) {
    add_number(families, std::string("web_") + name, help, static_cast<double>(value));
  };
  add("connections", "connections accepted since the start", web.connections);
  add("refused", "new connections closed because of a limit", web.refused);
  add("evicted", "older connections closed to make room for newer ones", web.evicted);
  add("accepts_failed", "times that the system gave no socket to a connection", web.accepts_failed);
  add("certificate_ends_seconds", "end of the certificate, UTC since 1970; 0: there is none",
      web.certificate_ends_s);
  add("certificates_read", "certificates that replaced the first one", web.certificates_read);
  add("certificates_refused", "new certificates that could not be used", web.certificates_refused);
  add("connections_open", "connections now", web.connections_open);
  add("requests", "requests answered since the start", web.requests);
  add("websockets", "WebSockets opened since the start", web.websockets);
  add("websockets_open", "WebSockets now", web.websockets_open);
  add("links_failed", "WebSockets that got no connection to their server", web.links_failed);
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
  add("log_lines_dropped", "lines of the log that could not be written", web.log_lines_dropped);
  std::vector<prometheus::MetricFamily> all;
  for (auto& [name, family] : families) all.push_back(std::move(family));
  return prometheus::TextSerializer().Serialize(all);
}

}  // namespace runstone
