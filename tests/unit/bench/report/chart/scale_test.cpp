// Scales: round ticks, straight maps, and a result for any values.
#include "tests/bench/report/chart/scale.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace runstone::bench::chart;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kNotFinite = std::numeric_limits<double>::infinity();

std::vector<std::string> texts_of(const Scale& scale) {
  std::vector<std::string> out;
  for (const Tick& tick : scale.ticks()) out.push_back(tick.text);
  return out;
}

Scale scale_of(std::vector<double> values, bool is_log, Scale::Start start, Scale::Ends ends,
               std::size_t ticks) {
  return {values, is_log, start, ends, ticks};
}

}  // namespace

TEST_CASE("a linear scale has ticks in steps of 1, 2 or 5", "[chart]") {
  using Texts = std::vector<std::string>;
  const auto bars = Scale::Start::bars;
  CHECK(texts_of(scale_of({3, 87}, false, bars, Scale::Ends::round, 6)) ==
        Texts{"0", "20", "40", "60", "80", "100"});
  CHECK(texts_of(scale_of({3, 87}, false, bars, Scale::Ends::tight, 6)) ==
        Texts{"0", "20", "40", "60", "80"});
  CHECK(texts_of(scale_of({0.02, 0.1}, false, bars, Scale::Ends::round, 4)) ==
        Texts{"0.00", "0.05", "0.10"});
  CHECK(texts_of(scale_of({-4, 12}, false, bars, Scale::Ends::round, 5)) ==
        Texts{"-5", "0", "5", "10", "15"});
  CHECK(texts_of(scale_of({12000, 12004}, false, Scale::Start::lowest, Scale::Ends::round, 6)) ==
        Texts{"12,000", "12,001", "12,002", "12,003", "12,004"});
}

TEST_CASE("a logarithmic scale has ticks at 1, 2 and 5, at decades, or at some of them",
          "[chart]") {
  using Texts = std::vector<std::string>;
  const auto lowest = Scale::Start::lowest;
  CHECK(texts_of(scale_of({3, 70}, true, lowest, Scale::Ends::round, 7)) ==
        Texts{"2", "5", "10", "20", "50", "100"});
  CHECK(texts_of(scale_of({3, 7000}, true, lowest, Scale::Ends::round, 5)) ==
        Texts{"10", "100", "1,000", "10,000"});
  CHECK(texts_of(scale_of({1, 1e6}, true, lowest, Scale::Ends::round, 4)) ==
        Texts{"1", "100", "10,000", "1,000,000"});
  // Between 2 and 5 there is no 1-2-5 value.
  CHECK(texts_of(scale_of({2.2, 4.3}, true, lowest, Scale::Ends::tight, 5)) == Texts{"3", "4"});
}

TEST_CASE("values map to places, linearly or by ratio, and never beyond the ends", "[chart]") {
  Scale linear = scale_of({0, 100}, false, Scale::Start::bars, Scale::Ends::round, 6);
  linear.lay(200, 0);  // downwards, as heights are
  CHECK(linear.place(0) == Approx(200));
  CHECK(linear.place(25) == Approx(150));
  CHECK(linear.place(100) == Approx(0));
  CHECK(linear.place(1e9) == Approx(0));
  CHECK(linear.base() == Approx(200));

  Scale log = scale_of({1, 1000}, true, Scale::Start::lowest, Scale::Ends::round, 6);
  log.lay(0, 300);
  CHECK(log.place(1) == Approx(0).margin(1e-9));
  CHECK(log.place(10) == Approx(100));
  CHECK(log.place(1000) == Approx(300));
  CHECK(log.place(0.001) == Approx(0).margin(1e-9));

  Scale below = scale_of({-50, -10}, false, Scale::Start::bars, Scale::Ends::round, 6);
  below.lay(0, 100);
  CHECK(below.base() == Approx(100));  // 0 is at the end
}

TEST_CASE("the lowest bar of a logarithmic scale can be seen", "[chart]") {
  for (const auto ends : {Scale::Ends::round, Scale::Ends::tight}) {
    Scale scale = scale_of({10, 5000}, true, Scale::Start::bars, ends, 6);
    scale.lay(0, 100);
    CHECK(scale.place(10) - scale.base() > 2);
  }
}

TEST_CASE("a scale knows the values that it cannot show", "[chart]") {
  for (const double value : {kNan, kNotFinite, -kNotFinite, 1e300, -1e300}) {
    CAPTURE(value);
    CHECK_FALSE(Scale::can_show(value, false));
    CHECK_FALSE(Scale::can_show(value, true));
  }
  CHECK(Scale::can_show(0, false));
  CHECK(Scale::can_show(-3, false));
  CHECK_FALSE(Scale::can_show(0, true));
  CHECK_FALSE(Scale::can_show(-3, true));
  CHECK_FALSE(Scale::can_show(1e-300, true));
  CHECK_FALSE(
      scale_of({kNan, kNotFinite}, false, Scale::Start::bars, Scale::Ends::round, 5).has_values());
  CHECK_FALSE(scale_of({0, -1}, true, Scale::Start::bars, Scale::Ends::round, 5).has_values());
  CHECK(scale_of({kNan, 1}, true, Scale::Start::bars, Scale::Ends::round, 5).has_values());
}

TEST_CASE("any values give a scale with separate ends, few ascending ticks, and positions for all",
          "[chart][property]") {
  std::mt19937 random(Catch::rngSeed());
  const auto any = [&] {
    switch (random() % 8) {
      case 0:
        return 0.0;
      case 1:
        return kNan;
      case 2:
        return kNotFinite;
      case 3:
        return random() % 2 == 0 ? 1e16 + static_cast<double>(random() % 5) : 5e-324;
      default:
        return (random() % 3 == 0 ? -1 : 1) * std::exp(static_cast<double>(random() % 160) - 80);
    }
  };
  for (int round = 0; round < 4000; ++round) {
    std::vector<double> values(random() % 4);
    for (double& value : values) value = any();
    const bool is_log = random() % 2 == 0;
    const auto start = random() % 2 == 0 ? Scale::Start::bars : Scale::Start::lowest;
    const auto ends = random() % 2 == 0 ? Scale::Ends::round : Scale::Ends::tight;
    const std::size_t ticks = 2 + random() % 8;
    CAPTURE(Catch::rngSeed(), values, is_log, start == Scale::Start::bars,
            ends == Scale::Ends::round, ticks);
    Scale scale(values, is_log, start, ends, ticks);
    scale.lay(10, 110);
    REQUIRE(scale.low() < scale.high());
    REQUIRE(scale.ticks().size() <= std::max<std::size_t>(ticks, 5));
    for (std::size_t i = 1; i < scale.ticks().size(); ++i) {
      REQUIRE(scale.ticks()[i - 1].value < scale.ticks()[i].value);
    }
    for (const double value : values) {
      if (!scale.can_show(value)) continue;
      REQUIRE(scale.place(value) >= 10);
      REQUIRE(scale.place(value) <= 110);
    }
    REQUIRE(scale.base() >= 10);
    REQUIRE(scale.base() <= 110);
  }
}
