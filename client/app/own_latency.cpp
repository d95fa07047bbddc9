#include "client/app/own_latency.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace runstone {

nlohmann::ordered_json own_latency_json(const Histogram& own_us) {
  const auto at = [&](double share) { return own_us.percentile(share).value_or(0); };
  return {{"p50", at(0.5)}, {"p90", at(0.9)}, {"p99", at(0.99)}, {"max", at(1)}};
}

std::string own_latency_line(const Histogram& own_us) {
  const auto ms = [&](double share) {
    return static_cast<double>(own_us.percentile(share).value_or(0)) / 1000;
  };
  return fmt::format("due to confirmed, ms: p50 {:.2f} p90 {:.2f} p99 {:.2f} max {:.2f}\n", ms(0.5), ms(0.9),
                     ms(0.99), ms(1));
}

}  // namespace runstone
