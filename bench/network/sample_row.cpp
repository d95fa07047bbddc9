#include "bench/network/sample_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "bench/network/testbed.hpp"

namespace runstone::bench {
namespace {

constexpr double kBarMax = 40;

}  // namespace

std::vector<SampleRow> sample_rows(const nlohmann::json& histogram) {
  std::vector<SampleRow> out;
  const auto rows = histogram.find("rows");
  if (rows == histogram.end()) return out;
  for (const nlohmann::json& row : *rows) {
    out.push_back({number_in(row.at(0)) / 1000, number_in(row.at(1)) / 1000, number_in(row.at(2))});
  }
  return out;
}

std::string histogram_table(std::span<const SampleRow> rows, double never) {
  double all = never, most = never, so_far = 0;
  for (const SampleRow& row : rows) {
    all += row.samples;
    most = std::max(most, row.samples);
  }
  std::string out =
      "| from, below ms | samples | share, % | so far, % | |\n|---|---|---|---|---|\n";
  const auto write = [&](const std::string& limits, double samples) {
    if (samples == 0) return;
    so_far += samples;
    out += fmt::format(
        "| {} | {:.0f} | {:.3f} | {:.3f} | {} |\n", limits, samples, 100 * samples / all,
        100 * so_far / all,
        std::string(static_cast<std::size_t>(std::ceil(kBarMax * samples / most)), '#'));
  };
  for (const SampleRow& row : rows) {
    write(fmt::format("{:.3f}, {:.3f}", row.from_ms, row.below_ms), row.samples);
  }
  write("never", never);
  return out;
}

}  // namespace runstone::bench
