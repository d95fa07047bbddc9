// Findings: everything in a report's folder, and the warnings that a reader needs.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/report/finding.hpp"
#include "tests/bench/report/rows.hpp"

namespace runstone::bench {

/// The errors of steps that failed in this run, by their names.
using StepFailures = std::map<std::string, std::string>;

class Findings {
 public:
  Findings() = default;
  Findings(Findings&&) = default;
  Findings(const Findings&) = delete;  // Rows and common() point into it
  static Findings read(const std::string& folder, const std::vector<std::string>& steps,
                       const StepFailures& failures);

  /// Returns null if there is none.
  const Finding* find(const std::string& step) const;
  /// Returns rows of the step's result: its member of that name, or the result itself if it is an
  /// array; none if there are none.
  Rows rows(const std::string& step, const char* member = "rows") const;
  /// Returns one row: a member of the step's result, or the result itself (""); no row if there is
  /// none.
  Rows object(const std::string& step, const std::string& member) const;
  /// Joins the figures of several network steps.
  Rows figures(const std::vector<std::string>& steps) const;

  /// Returns the finding whose machine most findings share, or null if nothing was measured.
  const Finding* common() const { return common_; }
  /// Returns the warnings for a figure of these steps, one sentence each: missing, failed, broken,
  /// or from another machine, commit or length of run than the others. Returns an empty list if
  /// there are none.
  std::vector<std::string> doubts(const std::vector<std::string>& steps) const;
  bool is_missing(const std::vector<std::string>& steps) const;

 private:
  std::map<std::string, Finding> found_;
  std::map<std::string, std::string> missing_;  // reason by step
  StepFailures failed_;
  const Finding* common_ = nullptr;
};

}  // namespace runstone::bench
