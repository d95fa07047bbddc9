#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "tests/bench/edits/edit_bench.hpp"
#include "tests/bench/frames/frames_bench.hpp"
#include "tests/bench/harness/bench_options.hpp"
#include "tests/bench/meshing/chunk_edge.hpp"
#include "tests/bench/meshing/mesh_bench.hpp"
#include "tests/bench/network/net_bench.hpp"
#include "tests/bench/report/scenario_case.hpp"
#include "tests/bench/report/step.hpp"
#include "tests/bench/storage/storage_bench.hpp"
#include "tests/bench/wire/bytes_bench.hpp"

namespace runstone::bench {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;
using Measured = Result<json, std::string>;

/// Returns the JSON that a benchmark writes.
template <class T>
Measured json_of(const Result<T, std::string>& result) {
  if (!result) return Unexpected<std::string>{result.error()};
  std::stringstream text;
  write_json(*result, text);
  return json::parse(text);
}

std::string joined(const Words& words) { return fmt::format("{}", fmt::join(words, ",")); }

class Steps {
 public:
  explicit Steps(const ReportOptions& options) : options_(options) {}

  void add(std::string name, std::string command, double quick_seconds, double seconds,
           std::function<Measured(std::ostream&)> measure) {
    const double expected = options_.is_quick ? quick_seconds : seconds;
    const bool has_world = command.starts_with("net") || command.starts_with("frames") ||
                           command.starts_with("storage") ||
                           command.find("luanti") != std::string::npos;
    if (has_world) command += " --luanti DIR";
    out_.push_back({std::move(name), std::move(command), expected, std::move(measure)});
  }

  struct MeshCase {
    Words worlds, parts = {};
    std::vector<unsigned> edges = {32};
    Words orders = {"best"}, meshers = {};
  };
  void add_mesh(std::string name, double quick_seconds, double seconds, const MeshCase& what) {
    BenchOptions bench = bench_options(15);
    bench.worlds = what.worlds;
    bench.parts = what.parts;
    bench.edges = what.edges;
    bench.orders = what.orders;
    bench.meshers = what.meshers;
    std::string command =
        fmt::format("mesh --worlds {} --edges {} --orders {}", joined(what.worlds),
                    fmt::join(what.edges, ","), joined(what.orders));
    if (!what.parts.empty()) command += " --parts " + joined(what.parts);
    if (!what.meshers.empty()) command += " --meshers " + joined(what.meshers);
    command += fmt::format(" --min-runs {}", bench.repetitions);
    add(std::move(name), std::move(command), quick_seconds, seconds,
        [bench](std::ostream& progress) { return json_of(run_mesh_bench(bench, progress)); });
  }

  void add_net(std::string name, const std::string& experiment, const Words& profiles,
               double quick_seconds, double seconds, const std::function<void(NetOptions&)>& set) {
    NetOptions net;
    net.experiments = {experiment};
    net.profiles = profiles;
    net.luanti = options_.luanti;
    net.repetitions = options_.is_quick ? 1 : 3;
    net.edits = options_.is_quick ? 100 : 400;
    net.fleet_seconds = options_.is_quick ? 3 : 20;
    set(net);
    std::string command = "net --experiments " + experiment;
    if (!profiles.empty()) command += " --profiles " + joined(profiles);
    if (!net.worlds.empty()) command += " --worlds " + joined(net.worlds);
    if (experiment == "latency") command += fmt::format(" --edits {}", net.edits);
    if (experiment == "transfer") command += fmt::format(" --min-runs {}", net.repetitions);
    if (experiment == "crowd") {
      command += fmt::format(" --clients {} --crowd-seconds {}", fmt::join(net.clients, ","),
                             net.fleet_seconds);
    }
    add(std::move(name), std::move(command), quick_seconds, seconds,
        [net](std::ostream& progress) { return json_of(run_net_bench(net, progress)); });
  }

  BenchOptions bench_options(unsigned repetitions) const {
    BenchOptions bench;
    bench.luanti = options_.luanti;
    bench.repetitions = options_.is_quick ? 3 : repetitions;
    return bench;
  }
  const std::string& luanti() const { return options_.luanti; }
  bool is_quick() const { return options_.is_quick; }
  std::vector<Step> take() { return std::move(out_); }

 private:
  const ReportOptions& options_;
  std::vector<Step> out_;
};

void add_scenarios(Steps& steps) {
  steps.add("facts", "", 2, 2,
            [](std::ostream& progress) -> Measured { return scenario_facts(progress); });
  const unsigned repetitions = steps.is_quick() ? 1 : 9;
  steps.add("thesis", "", 15, 100, [repetitions](std::ostream& progress) -> Measured {
    return scenario_times(repetitions, progress);
  });
}

void add_meshing(Steps& steps) {
  const Words landscapes = {"hills", "terrain", "overhangs", "caves", "town", "luanti"};
  const Words adversaries = {"noise", "noise_mixed", "sparse", "checkerboard"};
  steps.add_mesh("meshers", 10, 60, {{"scenarios"}});
  steps.add_mesh("landscapes", 20, 120, {landscapes});
  steps.add_mesh("adversaries", 5, 30, {adversaries});
  steps.add_mesh("orders", 10, 90,
                 {{"scenarios", "hills", "terrain", "overhangs", "caves", "town"},
                  {},
                  {32},
                  {"all"},
                  {"rdm", "decode_binary"}});
  const Words scaled = {"rdm", "decode_binary", "grid_rdm", "rle_rdm", "culled"};
  steps.add_mesh("chunk-sizes", 5, 30,
                 {{"scenarios"}, {"1", "17"}, {8, 16, 32, 64, 128}, {"best"}, scaled});
  steps.add_mesh("chunk-sizes-terrain", 5, 30,
                 {{"terrain"}, {}, {8, 16, 32, 64, 128}, {"best"}, scaled});
}

void add_drawing(Steps& steps) {
  FramesOptions frames;
  frames.luanti = steps.luanti();
  frames.frames = steps.is_quick() ? 6 : 15;
  frames.pictures = steps.is_quick() ? 1 : 2;
  frames.vertices_max = steps.is_quick() ? 3'000'000 : 12'000'000;
  std::string command = fmt::format("frames --frames {} --pictures {} --vertices-max {}",
                                    frames.frames, frames.pictures, frames.vertices_max);
  if (steps.is_quick()) {
    frames.width = 640;
    frames.height = 360;
    for (const unsigned scenario : {5U, 8U, 13U, 14U, 20U, 23U, 33U}) {
      frames.worlds.push_back(fmt::format("scenario_{}", scenario));
    }
    frames.worlds.emplace_back("luanti");
    command += " --size 640x360 --worlds " + joined(frames.worlds);
  }
  steps.add("frames", std::move(command), 45, 700, [frames](std::ostream& progress) {
    return json_of(run_frames_bench(frames, progress));
  });
  BenchOptions storage = steps.bench_options(9);
  storage.edges = {32};
  steps.add(
      "storage", fmt::format("storage --edges 32 --min-runs {}", storage.repetitions), 20, 120,
      [storage](std::ostream& progress) { return json_of(run_storage_bench(storage, progress)); });
}

void add_edits(Steps& steps) {
  BenchOptions edits = steps.bench_options(15);
  edits.edits = steps.is_quick() ? 20'000 : 200'000;
  steps.add("edits", fmt::format("edits --edits {} --min-runs {}", edits.edits, edits.repetitions),
            2, 20,
            [edits](std::ostream& progress) { return json_of(run_edit_bench(edits, progress)); });
  BenchOptions edges = steps.bench_options(15);
  edges.edges = {16, 32, 64};
  edges.worlds =
      steps.is_quick() ? Words{"terrain"} : Words{"hills", "terrain", "caves", "town", "luanti"};
  steps.add("dirty-layers", fmt::format("chunk-edge --worlds {}", joined(edges.worlds)), 10, 60,
            [edges](std::ostream& progress) { return json_of(run_chunk_edge(edges, progress)); });
  BenchOptions bytes = steps.bench_options(5);
  bytes.worlds = {"luanti", "terrain"};
  steps.add("bytes", fmt::format("bytes --worlds luanti,terrain --min-runs {}", bytes.repetitions),
            5, 20,
            [bytes](std::ostream& progress) { return json_of(run_bytes_bench(bytes, progress)); });
}

void add_network(Steps& steps) {
  for (const std::string profile : {"loopback", "lan", "broadband", "mobile", "lossy"}) {
    const bool is_short = profile == "loopback" || profile == "broadband";
    if (steps.is_quick() && !is_short) continue;
    steps.add_net("latency-" + profile, "latency", {profile}, 20, 60, [](NetOptions&) {});
    steps.add_net("transfer-" + profile, "transfer", {profile}, 8, 60, [](NetOptions& net) {
      net.worlds = {"luanti", "terrain", "caves", "town", "noise"};
    });
  }
  for (const unsigned clients : {1U, 10U, 100U, 300U, 1000U}) {
    if (steps.is_quick() && clients > 100) continue;
    steps.add_net(fmt::format("crowd-{}", clients), "crowd", {}, 8, 40 + clients / 20.0,
                  [clients](NetOptions& net) { net.clients = {clients}; });
  }
}

}  // namespace

std::vector<Step> report_steps(const ReportOptions& options) {
  Steps steps(options);
  add_scenarios(steps);
  add_meshing(steps);
  add_drawing(steps);
  add_edits(steps);
  add_network(steps);
  return steps.take();
}

}  // namespace runstone::bench
