// Order statistics and means of samples that are not empty.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace runstone::bench {

/// The sample below which `share` of them lie, 0 .. 1: 0.5 is the median (the upper one of an even number).
inline double quantile(std::vector<double> samples, double share) {
  const auto at = std::min(static_cast<std::size_t>(share * static_cast<double>(samples.size())),
                           samples.size() - 1);
  std::nth_element(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(at),
                   samples.end());
  return samples[at];
}
inline double median(std::vector<double> samples) { return quantile(std::move(samples), 0.5); }

/// Requires positive samples.
inline double geometric_mean(const std::vector<double>& samples) {
  double logs = 0;
  for (const double sample : samples) logs += std::log(sample);
  return std::exp(logs / static_cast<double>(samples.size()));
}

}  // namespace runstone::bench
