// Siege table: the results of a siege as figures, a table and targets.
#pragma once
#include <string>
#include <vector>

#include "bench/network/figure.hpp"
#include "bench/network/net_options.hpp"
#include "bench/network/siege_result.hpp"

namespace runstone::bench {

void add_siege_figures(const SiegeResult& result, std::vector<Figure>& figures);
void add_siege_targets(const SiegeResult& result, const NetOptions& options,
                       std::vector<Target>& targets);
std::string siege_table(const SiegeResult& result, const NetOptions& options);

}  // namespace runstone::bench
