#include "bench/harness/machine_json.hpp"

#include <nlohmann/json.hpp>

namespace runstone::bench {

nlohmann::ordered_json json_of(const Machine& machine) {
  return {{"cpu", machine.cpu},
          {"cores", machine.cores},
          {"compiler", machine.compiler},
          {"commit", machine.commit},
          {"simd", machine.simd}};
}

}  // namespace runstone::bench
