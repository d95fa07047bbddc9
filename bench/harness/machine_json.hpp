// The machine in the form that every JSON report has.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "bench/harness/machine.hpp"

namespace runstone::bench {

nlohmann::ordered_json json_of(const Machine& machine);

}  // namespace runstone::bench
