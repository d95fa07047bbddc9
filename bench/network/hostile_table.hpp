// Hostile tables: the results of strangers and floods as figures, tables and targets.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "bench/network/figure.hpp"
#include "bench/network/hostile_result.hpp"
#include "bench/network/net_options.hpp"

namespace runstone::bench {

/// The functions below require at least one result. `experiment` is "strangers" or "floods".
void add_hostile_figures(std::span<const HostileResult> results, const std::string& experiment,
                         std::vector<Figure>& figures);
/// Adds the targets of the worst row of each sort.
void add_hostile_targets(std::span<const HostileResult> results, const std::string& experiment,
                         std::vector<Target>& targets);
/// `text` says what the rows are.
std::string hostile_table(std::span<const HostileResult> results, const std::string& title,
                          const std::string& text);

}  // namespace runstone::bench
