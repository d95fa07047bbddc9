#include "bench/harness/target_json.hpp"

#include <nlohmann/json.hpp>

namespace runstone::bench {

nlohmann::ordered_json json_of(std::span<const Target> targets) {
  auto out = nlohmann::ordered_json::array();
  for (const Target& target : targets) {
    out.push_back({{"case", target.what},
                   {"bar", target.wanted},
                   {"measured", target.measured},
                   {"verdict", name_of(target.verdict)}});
  }
  return out;
}

}  // namespace runstone::bench
