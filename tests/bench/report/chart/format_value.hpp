// The form of numbers in charts.
#pragma once
#include <string>

namespace runstone::bench::chart {

/// Returns three significant digits without trailing zeros, in groups of thousands: "0.0123",
/// "1.5", "12,300"; from 1e9 and below 1e-4 with an exponent ("1.23e9"). NaN is "not measured", an
/// infinity "inf" or "-inf".
std::string format_value(double value);

/// Returns a multiple of `step` with as many digits as distinguish it from the next one: "1,005"
/// for a step of 5.
std::string format_tick(double value, double step);

}  // namespace runstone::bench::chart
