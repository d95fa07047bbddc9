// Attack tables: the results of attacks as figures, tables and targets. An attack is compared with
// the row in which nobody attacks.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "bench/network/attack_result.hpp"
#include "bench/network/figure.hpp"
#include "bench/network/net_options.hpp"

namespace runstone::bench {

/// The functions below require that the first result is that of the quiet row.
void add_attack_figures(std::span<const AttackResult> results, const NetOptions& options,
                        std::vector<Figure>& figures);
/// Adds the targets of the worst attack of each sort. Adds none if nobody attacked.
void add_attack_targets(std::span<const AttackResult> results, const NetOptions& options,
                        std::vector<Target>& targets);
std::string attack_tables(std::span<const AttackResult> results, const NetOptions& options);

}  // namespace runstone::bench
