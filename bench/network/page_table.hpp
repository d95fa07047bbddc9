// Page tables: the times of the gateway's pages under attack as figures, a table and targets.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "bench/network/attack_result.hpp"
#include "bench/network/figure.hpp"

namespace runstone::bench {

/// Adds nothing for attacks without a gateway.
void add_page_figures(const AttackResult& result, std::vector<Figure>& figures);
void add_page_targets(std::span<const AttackResult> results, std::vector<Target>& targets);
/// Returns an empty text if no attack had a gateway.
std::string page_table(std::span<const AttackResult> results);

}  // namespace runstone::bench
