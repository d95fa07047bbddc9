// Findings: all that lies in a report's folder, and what about it a reader must be told.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/report/finding.hpp"
#include "tests/bench/report/rows.hpp"

namespace runstone::bench {

/// Why steps of this run failed, by their names.
using StepFailures = std::map<std::string, std::string>;

class Findings {
 public:
  Findings() = default;
  Findings(Findings&&) = default;
  Findings(const Findings&) = delete;  // Rows and common() point into it
  static Findings read(const std::string& folder, const std::vector<std::string>& steps,
                       const StepFailures& failures);

  /// Null if there is none.
  const Finding* find(const std::string& step) const;
  /// Of the step's result: of its member of that name, or of an array itself. None if there is none.
  Rows rows(const std::string& step, const char* member = "rows") const;
  /// An object that is a member of the step's result, or the result itself (""), as one row. None if there is none.
  Rows object(const std::string& step, const std::string& member) const;
  /// Joins the figures of the network lab of several steps.
  Rows figures(const std::vector<std::string>& steps) const;

  /// What most findings were measured on; null if nothing was measured.
  const Finding* common() const { return common_; }
  /// Why a figure of these steps is not what it should be, one sentence each: missing, failed, broken, or of
  /// another machine, commit or length of run than the others. Empty if all is well.
  std::vector<std::string> doubts(const std::vector<std::string>& steps) const;
  bool is_missing(const std::vector<std::string>& steps) const;

 private:
  std::map<std::string, Finding> found_;
  std::map<std::string, std::string> missing_;  // why, by step
  StepFailures failed_;
  const Finding* common_ = nullptr;
};

}  // namespace runstone::bench
