// The thesis' 37 scenarios as the thesis measured them: all 3 x 3 x 3 chunks, each with its
// neighbours among them.
#pragma once
#include <iosfwd>
#include <nlohmann/json.hpp>

#include "bench/harness/bench_options.hpp"
#include "bench/harness/machine.hpp"

namespace CLI {
class App;
}

namespace runstone::bench {

struct ScenarioTable {
  Machine machine;
  unsigned repetitions = 0;  // of each chunk; 0: nothing was timed
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();  // flat objects of equal keys
};

/// Returns a row for each scenario: number, group (1 general, 2 random, 3 strips; thesis 8.2),
/// voxels, chunks without quads, and means over its 27 chunks of opaque voxels, runs in each axis
/// order ("runs_xyz"), runs in the cheapest order, bytes of run storage here, and bytes as the
/// thesis logs them.
ScenarioTable scenario_facts(std::ostream& progress);

/// Returns a row for each scenario and mesher (the thesis' meshers, the product, and the dense
/// baselines). "vertices" is the mean over all 27 chunks, as in the thesis. Times are over the
/// chunks that have quads ("chunks" of them): mean, median, least and greatest of a chunk's median,
/// and the mean share of each phase. Cost: one core, about a minute for each five repetitions.
ScenarioTable scenario_times(unsigned repetitions, std::ostream& progress);

/// Prints a table of Markdown.
void write_table(const ScenarioTable& table, std::ostream& out);
void write_json(const ScenarioTable& table, std::ostream& out);

/// Add the subcommands scenario-facts and scenario-times. `options` must outlive the parse.
CLI::App* add_scenario_facts_command(CLI::App& app, BenchOptions& options);
CLI::App* add_scenario_times_command(CLI::App& app, BenchOptions& options);

}  // namespace runstone::bench
