// Labels find room and never overlap.
#include "tests/bench/report/chart/label_placer.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace runstone::bench::chart;

TEST_CASE("positions are moved as little as possible", "[chart]") {
  CHECK(spread({10, 50, 90}, 15, 0, 100) == std::vector<double>{10, 50, 90});
  CHECK(spread({50, 50}, 10, 0, 100) == std::vector<double>{45, 55});
  CHECK(spread({52, 48, 50}, 10, 0, 100) == std::vector<double>{60, 40, 50});
  CHECK(spread({0, 0}, 10, 0, 100) == std::vector<double>{0, 10});
  CHECK(spread({100, 99}, 10, 0, 100) == std::vector<double>{100, 90});
  CHECK(spread({5, 5, 5}, 10, 0, 20) == std::vector<double>{0, 10, 20});
  CHECK(spread({5, 5, 5}, 10, 0, 19).empty());
  CHECK(spread({}, 10, 0, 19).empty());
}

TEST_CASE("spread positions keep their order, their distance and their bounds",
          "[chart][property]") {
  std::mt19937 random(Catch::rngSeed());
  for (int round = 0; round < 500; ++round) {
    std::vector<double> wanted(1 + random() % 16);
    for (double& at : wanted) at = static_cast<double>(random() % 300) - 20;
    CAPTURE(Catch::rngSeed(), wanted);
    const std::vector<double> placed = spread(wanted, 15, 0, 240);
    REQUIRE(placed.size() == wanted.size());
    for (std::size_t a = 0; a < placed.size(); ++a) {
      REQUIRE(placed[a] >= 0);
      REQUIRE(placed[a] <= 240);
      for (std::size_t b = 0; b < a; ++b) {
        REQUIRE(std::abs(placed[a] - placed[b]) >= 15 - 1e-9);
        if (wanted[a] < wanted[b]) REQUIRE(placed[a] < placed[b]);
      }
    }
  }
}

TEST_CASE("labels avoid points, each other and the edge, and stay beside their point", "[chart]") {
  LabelPlacer placer({0, 0, 200, 100});
  placer.block({0, 0, 200, 20});
  placer.block_point(100, 50, 5);
  placer.block_point(112, 50, 5);  // where the first label would go
  const auto first = placer.place(100, 50, 5, 40, 14);
  REQUIRE(first);
  CHECK_FALSE(overlap(*first, {107, 45, 10, 10}));
  CHECK_FALSE(overlap(*first, {0, 0, 200, 20}));
  const auto second = placer.place(112, 50, 5, 40, 14);
  REQUIRE(second);
  CHECK_FALSE(overlap(*first, *second));
  CHECK(lead_to(*second, 112, 50).length < 20);
  CHECK_FALSE(placer.place(100, 50, 5, 300, 14));  // wider than the room
}

TEST_CASE("labels of many points never overlap", "[chart][property]") {
  std::mt19937 random(Catch::rngSeed());
  for (int round = 0; round < 100; ++round) {
    LabelPlacer placer({0, 0, 400, 200});
    std::vector<Box> labels;
    std::vector<std::pair<double, double>> points;
    points.reserve(20);
    for (int i = 0; i < 20; ++i) points.emplace_back(random() % 400, random() % 200);
    for (const auto& [x, y] : points) placer.block_point(x, y, 4);
    for (const auto& [x, y] : points) {
      if (const auto box = placer.place(x, y, 4, 60, 14)) labels.push_back(*box);
    }
    CAPTURE(Catch::rngSeed(), round);
    REQUIRE(labels.size() >= 8);
    for (std::size_t a = 0; a < labels.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) REQUIRE_FALSE(overlap(labels[a], labels[b]));
      for (const auto& [x, y] : points) REQUIRE_FALSE(overlap(labels[a], {x - 4, y - 4, 8, 8}));
    }
  }
}
