// Step: one measurement of the report, with a finding of its own. Steps are small enough that an
// interrupted run loses a few minutes at most.
#pragma once
#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "tests/bench/report/report_options.hpp"

namespace runstone::bench {

struct Step {
  std::string name;  // also of its file
  // The arguments of runstone-bench that measure the same; empty if only the report does.
  std::string command;
  double seconds = 0;  // expected duration
  std::function<Result<nlohmann::json, std::string>(std::ostream& progress)> measure;
};

/// Returns all steps, in the order in which they run. `options` must outlive them.
std::vector<Step> report_steps(const ReportOptions& options);

}  // namespace runstone::bench
