// Order statistics and means. All functions require samples that are not empty.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace runstone::bench {

/// Returns the sample below which `share` (0 .. 1) of the samples lie. A share of 0.5 gives the
/// median; of an even number of samples, the upper of the two middle ones.
inline double quantile(std::vector<double> samples, double share) {
  const auto at = std::min(static_cast<std::size_t>(share * static_cast<double>(samples.size())),
                           samples.size() - 1);
  std::nth_element(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(at),
                   samples.end());
  return samples[at];
}
inline double median(std::vector<double> samples) { return quantile(std::move(samples), 0.5); }

/// Returns the geometric mean. Requires positive samples.
inline double geometric_mean(const std::vector<double>& samples) {
  double logs = 0;
  for (const double sample : samples) logs += std::log(sample);
  return std::exp(logs / static_cast<double>(samples.size()));
}

}  // namespace runstone::bench
