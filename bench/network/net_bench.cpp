#include "bench/network/net_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "bench/network/attack_case.hpp"
#include "bench/network/backup_case.hpp"
#include "bench/network/fleet_case.hpp"
#include "bench/network/gateway_case.hpp"
#include "bench/network/horizon_case.hpp"
#include "bench/network/hostile_case.hpp"
#include "bench/network/join_case.hpp"
#include "bench/network/latency_case.hpp"
#include "bench/network/memory_case.hpp"
#include "bench/network/siege_case.hpp"
#include "bench/network/transfer_case.hpp"

namespace runstone::bench {
namespace {

struct Experiment {
  const char* name;
  Done (*measure)(Testbed&, NetFindings&);
};
constexpr std::array<Experiment, 12> kExperiments = {{{"latency", measure_latency},
                                                      {"join", measure_joins},
                                                      {"transfer", measure_transfers},
                                                      {"horizon", measure_horizon},
                                                      {"crowd", measure_fleets},
                                                      {"gateway", measure_gateway},
                                                      {"attack", measure_attacks},
                                                      {"memory", measure_memory},
                                                      {"siege", measure_siege},
                                                      {"strangers", measure_strangers},
                                                      {"floods", measure_floods},
                                                      {"backup", measure_backup}}};

/// Returns TCP's congestion control of this machine, which namespaces on it inherit.
std::string congestion_control() {
  std::ifstream in("/proc/sys/net/ipv4/tcp_congestion_control");
  std::string out = "unknown";
  in >> out;
  return out;
}

}  // namespace

Result<NetResult, std::string> run_net_bench(const NetOptions& options, std::ostream& progress) {
  NetResult out;
  out.machine = this_machine();
  const std::string why = why_no_namespaces();
  if (options.link == "namespaces" && !why.empty()) return failure(why);
  const bool real = options.link != "shaper" && why.empty();
  out.link = real ? "real packets between two network namespaces, "
                    "joined by a forwarder of ours over TUN devices"
                  : "a TCP proxy on loopback, in which loss is a segment that comes a round trip "
                    "later and slows nobody down";
  if (!real && !why.empty()) out.link += " (" + why + ")";
  out.link += "; congestion control " + congestion_control();
  take_interrupts();
  Testbed testbed(options, real ? LinkKind::namespaces : LinkKind::shaper, progress);
  for (const Experiment& experiment : kExperiments) {
    const auto& wanted = options.experiments;
    if (std::find(wanted.begin(), wanted.end(), experiment.name) == wanted.end()) continue;
    if (const auto done = experiment.measure(testbed, out.findings); !done)
      return failure(done.error());
  }
  return out;
}

void write_tables(const NetResult& result, std::ostream& out) {
  write_machine(result.machine, out);
  fmt::print(out, "\nLinks: {}. Each TCP connection has a link of its own.\n", result.link);
  fmt::print(out,
             "\n| link | round trip, ms | jitter each way, ms | Mbit/s | loss | queue, KiB |\n"
             "|---|---|---|---|---|---|\n");
  for (const test::LinkProfile& profile : test::link_profiles()) {
    if (profile.passes_all()) continue;
    fmt::print(out, "| {} | {} | {} | {} | {} % | {} |\n", profile.name,
               static_cast<double>(profile.round_trip_ns) / 1e6,
               static_cast<double>(profile.jitter_ns) / 1e6, profile.bits_per_second / 1'000'000,
               profile.loss * 100, profile.queue_bytes() / 1024);
  }
  fmt::print(out, "{}\n", result.findings.tables);
  write_targets(result.findings.targets, out);
}

void write_csv(const NetResult& result, std::ostream& out) {
  write_csv(result.findings.figures, out);
}

void write_json(const NetResult& result, std::ostream& out) {
  write_json(result.machine, result.findings.figures, result.findings.targets, out);
}

}  // namespace runstone::bench
