#include "tests/bench/report/chart/format_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace runstone::bench::chart {
namespace {

/// Turns "-1234567.5" into "-1,234,567.5".
std::string grouped(std::string digits) {
  const std::size_t first = digits.starts_with('-') ? 1 : 0;
  const std::size_t point = digits.find('.');
  std::size_t at = point == std::string::npos ? digits.size() : point;
  while (at > first + 3) {
    at -= 3;
    digits.insert(at, 1, ',');
  }
  return digits;
}

std::string without_zeros(std::string digits) {
  if (digits.find('.') == std::string::npos) return digits;
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.ends_with('.')) digits.pop_back();
  return digits;
}

}  // namespace

std::string format_value(double value) {
  if (std::isnan(value)) return "not measured";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  if (value == 0) return "0";
  // Rounds first: 999.6 becomes 1,000, and 0.00009996 becomes 0.0001.
  const std::string rounded = fmt::format("{:.2e}", value);
  const std::size_t split = rounded.find('e');
  const bool is_small = rounded[split + 1] == '-';
  int exponent = 0;
  std::from_chars(rounded.data() + split + 2, rounded.data() + rounded.size(), exponent);
  if (is_small) exponent = -exponent;
  if (exponent < -4 || exponent >= 9) {
    return fmt::format("{}e{}", without_zeros(rounded.substr(0, split)), exponent);
  }
  if (exponent < 2) return grouped(without_zeros(fmt::format("{:.{}f}", value, 2 - exponent)));
  const double unit = std::pow(10.0, exponent - 2);
  return grouped(fmt::format("{:.0f}", std::round(value / unit) * unit));
}

std::string format_tick(double value, double step) {
  if (std::abs(value) >= 1e9 || step < 1e-4) return value == 0 ? "0" : fmt::format("{:.6g}", value);
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return grouped(fmt::format("{:.{}f}", value + 0.0, decimals));
}

}  // namespace runstone::bench::chart
