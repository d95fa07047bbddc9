// Finding: the result of one step of the report and the machine of the measurement, in a file of
// its own. The file is written as a whole or not at all, so that an interrupted run continues where
// it stopped.
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
  std::string luanti;       // last name of the real world's folder
  std::string measured_at;  // UTC, as 2026-01-31T23:59:59Z
  double seconds = 0;       // duration of the measurement
  nlohmann::json result;    // the JSON that the step's benchmark writes
};

/// Returns the path of a step's finding in the report's folder.
std::string finding_file(const std::string& folder, const std::string& step);

/// Replaces the file atomically. The error names the file.
Result<void, std::string> write_finding(const std::string& folder, const Finding& finding);

inline constexpr const char* kNotMeasured = "not measured";

/// Reads a finding. The error is kNotMeasured, or says what is wrong with the file and where.
Result<Finding, std::string> read_finding(const std::string& folder, const std::string& step);

/// Returns true if two findings may be compared: same machine, compiler, commit, real world and
/// length of run.
bool is_comparable(const Finding& a, const Finding& b);

}  // namespace runstone::bench
