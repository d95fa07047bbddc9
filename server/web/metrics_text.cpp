#include "server/web/metrics_text.hpp"

#include <prometheus/text_serializer.h>

#include <limits>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "server/web/metric_kinds.hpp"

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

using prometheus::MetricType;

void add_number(Families& out, const std::string& name, const std::string& help, MetricType type,
                double value, std::string_view world = {}) {
  prometheus::ClientMetric metric;
  switch (type) {
    case MetricType::Counter:
      metric.counter.value = value;
      break;
    case MetricType::Gauge:
      metric.gauge.value = value;
      break;
    default:
      metric.untyped.value = value;
  }
  add_metric(out, name, help, type, std::move(metric), world);
}

/// Adds a metric with the value 1 and a text as its label.
void add_text(Families& out, const std::string& name, const std::string& help, const char* label,
              const std::string& text, std::string_view world) {
  prometheus::ClientMetric metric;
  metric.gauge.value = 1;
  metric.label.push_back({label, text});
  add_metric(out, name, help, MetricType::Gauge, std::move(metric), world);
}

/// Adds a histogram of the counters that describe it. A later server may have other bounds.
void add_waits(Families& out, const ServerStatus& server, const WaitMetric& waits,
               std::string_view world) {
  const std::string name(waits.name);
  if (!server.counters.contains(name + "_count")) return;  // an older server lacks some
  prometheus::ClientMetric metric;
  metric.histogram.sample_count = static_cast<std::uint64_t>(server.counter(name + "_count"));
  metric.histogram.sample_sum = static_cast<double>(server.counter(name + "_us")) / 1e6;
  for (const EditWaits& bucket : edit_waits(server, waits.name))
    metric.histogram.bucket.push_back({bucket.count, static_cast<double>(bucket.ms_max) / 1e3});
  metric.histogram.bucket.push_back(
      {metric.histogram.sample_count, std::numeric_limits<double>::infinity()});
  add_metric(out, name + "_seconds", waits.help, MetricType::Histogram, std::move(metric), world);
}

void add_server(Families& out, const ServerStatus& server, std::string_view world) {
  add_number(out, "up", "1 if the server answers the gateway", MetricType::Gauge,
             server.is_up ? 1 : 0, world);
  if (!server.is_up) return;
  for (const auto& [name, value] : server.counters) {
    if (is_part_of_waits(name)) continue;
    const MetricKind* kind = find_metric_kind(name);
    const MetricType type = kind == nullptr                      ? MetricType::Untyped
                            : kind->type == CounterType::counter ? MetricType::Counter
                                                                 : MetricType::Gauge;
    add_number(out, name, kind != nullptr ? kind->help : "counter of a later server", type,
               static_cast<double>(value), world);
  }
  for (const WaitMetric& waits : wait_metrics()) add_waits(out, server, waits, world);
  if (!server.version.empty())
    add_text(out, "build_info", "version of the server", "version", server.version, world);
  if (!server.read_only.empty()) {
    add_text(out, "read_only_info", "why edits are refused; absent if they are taken", "reason",
             server.read_only, world);
  }
}

}  // namespace

std::string metrics_text(std::span<const WorldStatus> worlds, const WebCounters& web) {
  Families families;
  for (const WorldStatus& world : worlds) add_server(families, *world.status, world.name);
  const auto add = [&](MetricType type, const char* name, const char* help, std::uint64_t value) {
    add_number(families, std::string("web_") + name, help, type, static_cast<double>(value));
  };
  const auto counter = [&](const char* name, const char* help, std::uint64_t value) {
    add(MetricType::Counter, name, help, value);
  };
  const auto gauge = [&](const char* name, const char* help, std::uint64_t value) {
    add(MetricType::Gauge, name, help, value);
  };
  counter("connections", "connections accepted since the start", web.connections);
  counter("refused", "new connections closed because of a limit", web.refused);
  counter("evicted", "older connections closed to make room for newer ones", web.evicted);
  counter("accepts_failed", "times that the system gave no socket to a connection",
          web.accepts_failed);
  gauge("certificate_ends_seconds", "end of the certificate, UTC since 1970; 0: there is none",
        web.certificate_ends_s);
  counter("certificates_read", "certificates that replaced the first one", web.certificates_read);
  counter("certificates_refused", "new certificates that could not be used",
          web.certificates_refused);
  gauge("connections_open", "connections now", web.connections_open);
  counter("requests", "requests answered since the start", web.requests);
  counter("websockets", "WebSockets opened since the start", web.websockets);
  gauge("websockets_open", "WebSockets now", web.websockets_open);
  counter("links_failed", "WebSockets that got no connection to their server", web.links_failed);
  counter("rules_broken", "WebSockets closed because of what they sent", web.rules_broken);
  counter("frames_in", "frames from browsers", web.frames_in);
  counter("frames_out", "frames to browsers", web.frames_out);
  counter("bytes_in", "bytes of frames from browsers", web.bytes_in);
  counter("bytes_out", "bytes of frames to browsers", web.bytes_out);
  counter("map_requests", "requests that the map answered", web.map_requests);
  counter("map_refused", "requests for the map refused because of a limit", web.map_refused);
  counter("map_not_modified", "pictures that the browser had", web.map_not_modified);
  counter("map_work_us", "microseconds of drawing", web.map_work_us);
  gauge("memory_bytes", "memory of the gateway in RAM", web.memory_bytes);
  gauge("map_cache_bytes", "memory of what the map has drawn", web.map_cache_bytes);
  counter("log_lines_dropped", "lines of the log that could not be written", web.log_lines_dropped);
  std::vector<prometheus::MetricFamily> all;
  for (auto& [name, family] : families) all.push_back(std::move(family));
  return prometheus::TextSerializer().Serialize(all);
}

}  // namespace runstone
