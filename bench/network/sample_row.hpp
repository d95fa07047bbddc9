// SampleRow: the number of samples of a latency between two limits, from a histogram in a report of
// runstone-bot.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace runstone::bench {

struct SampleRow {
  double from_ms = 0, below_ms = 0;  // from_ms <= sample < below_ms
  double samples = 0;
  friend bool operator==(const SampleRow&, const SampleRow&) = default;
};

/// Returns the rows of such a histogram, ascending; none if it has none.
std::vector<SampleRow> sample_rows(const nlohmann::json& histogram);

/// Returns a table in Markdown: a line for each row and, if there are any, one for the samples that
/// `never` arrived. Shares are of all samples, these included. Every line with samples has a bar.
std::string histogram_table(std::span<const SampleRow> rows, double never);

}  // namespace runstone::bench
