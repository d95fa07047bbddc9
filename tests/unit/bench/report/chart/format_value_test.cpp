// The form of numbers in charts.
#include "tests/bench/report/chart/format_value.hpp"

#include <catch2/catch.hpp>
#include <limits>

using runstone::bench::chart::format_value;

TEST_CASE("values have three digits and groups of thousands", "[chart]") {
  CHECK(format_value(0) == "0");
  CHECK(format_value(-0.0) == "0");
  CHECK(format_value(2) == "2");
  CHECK(format_value(1.5) == "1.5");
  CHECK(format_value(12.345) == "12.3");
  CHECK(format_value(123.4) == "123");
  CHECK(format_value(100) == "100");
  CHECK(format_value(1234) == "1,230");
  CHECK(format_value(-1234567) == "-1,230,000");
  CHECK(format_value(123456789) == "123,000,000");
  CHECK(format_value(0.0123456) == "0.0123");
  CHECK(format_value(0.5) == "0.5");
}

TEST_CASE("a value that rounds up has the form of the rounded value", "[chart]") {
  CHECK(format_value(999.6) == "1,000");
  CHECK(format_value(9.999) == "10");
  CHECK(format_value(0.00009996) == "0.0001");
  CHECK(format_value(999.9e6) == "1e9");
}

TEST_CASE("very large values, very small values and NaN have a form", "[chart]") {
  CHECK(format_value(1.234e9) == "1.23e9");
  CHECK(format_value(-4.5e-7) == "-4.5e-7");
  CHECK(format_value(std::numeric_limits<double>::max()) == "1.8e308");
  CHECK(format_value(std::numeric_limits<double>::quiet_NaN()) == "not measured");
  CHECK(format_value(std::numeric_limits<double>::infinity()) == "inf");
  CHECK(format_value(-std::numeric_limits<double>::infinity()) == "-inf");
}
