// How charts write numbers.
#pragma once
#include <string>

namespace runstone::bench::chart {

/// Three significant digits without trailing zeros, groups of thousands: "0.0123", "1.5", "12,300"; from 1e9 and below
/// 1e-4 with an exponent ("1.23e9"). NaN is "not measured", an infinity "inf" or "-inf".
std::string format_value(double value);

/// A multiple of `step`, with as many digits as tell it from the next one: "1,005" for a step of 5.
std::string format_tick(double value, double step);

}  // namespace runstone::bench::chart
