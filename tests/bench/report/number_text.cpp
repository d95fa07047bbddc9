#include "tests/bench/report/number_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tests/bench/report/chart/format_value.hpp"

namespace runstone::bench {

std::string ratio_text(double ratio) {
  return std::isnan(ratio) ? chart::format_value(ratio) : fmt::format("{:.3f}", ratio);
}

std::string count_text(double count) {
  if (!std::isfinite(count)) return chart::format_value(count);
  std::string out = fmt::format("{:.0f}", count);
  for (std::size_t i = out.size(); i > 3 && out[i - 4] != '-'; i -= 3) out.insert(i - 3, ",");
  return out;
}

std::string time_text(double ns) {
  if (std::isnan(ns)) return chart::format_value(ns);
  if (ns < 1e3) return chart::format_value(ns) + " ns";
  if (ns < 1e6) return chart::format_value(ns / 1e3) + " µs";
  if (ns < 1e9) return chart::format_value(ns / 1e6) + " ms";
  return chart::format_value(ns / 1e9) + " s";
}

}  // namespace runstone::bench
