// Step: one thing the report measures, with a finding of its own. Steps are cut so that an interrupted run
// loses a few minutes at most.
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
  std::string name;     // and of its file
  std::string command;  // that measures the same alone; empty: only the report does
  double seconds = 0;   // that it takes about
  std::function<Result<nlohmann::json, std::string>(std::ostream& progress)> measure;
};

/// All of them, in the order in which they run. `options` must outlive them.
std::vector<Step> report_steps(const ReportOptions& options);

}  // namespace runstone::bench
