// Targets in the form that every JSON report has.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "bench/harness/target.hpp"

namespace runstone::bench {

/// Returns an array with an object for each target.
nlohmann::ordered_json json_of(std::span<const Target> targets);

}  // namespace runstone::bench
