// Finding: what one step of the report measured, with what it was measured on, as a file of its own. It is
// there as a whole or not at all, so that a run that was cut off goes on where it stopped.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "common/core/result.hpp"
#include "tests/bench/harness/machine.hpp"

namespace runstone::bench {

struct Finding {
  std::string step;
  Machine machine;
  bool is_quick = false;
  std::string luanti;       // the real world's folder, its last name
  std::string measured_at;  // UTC, as 2026-01-31T23:59:59Z
  double seconds = 0;       // that it took
  nlohmann::json result;    // what the step's benchmark writes as JSON
};

/// Where a step's finding lies in the report's folder.
std::string finding_file(const std::string& folder, const std::string& step);

/// Replaces the file in one step. The error names the file.
Result<void, std::string> write_finding(const std::string& folder, const Finding& finding);

inline constexpr const char* kNotMeasured = "not measured";

/// The error says why there is none: kNotMeasured, or what is wrong with the file and where.
Result<Finding, std::string> read_finding(const std::string& folder, const std::string& step);

/// Whether both may be set against each other: same machine, compiler, commit, real world and length of run.
bool is_comparable(const Finding& a, const Finding& b);

}  // namespace runstone::bench
