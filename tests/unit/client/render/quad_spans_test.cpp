#include "client/render/quad_spans.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "common/core/hash.hpp"

using namespace runstone;

namespace {

constexpr int kEdge = 16;

/// Returns layers with up to three quads in each (direction, layer).
QuadLayers random_layers(SplitMix64& rng) {
  QuadLayers out;
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    for (std::size_t l = 0; l < kSideMax; ++l) {
      out.first[d * kSideMax + l] = static_cast<std::uint32_t>(out.quads.size());
      if (l >= kEdge) continue;
      const auto plane = static_cast<std::uint8_t>(l);
      QuadFields quad{1, 2, 3, 1, 1, static_cast<Direction>(d), 1};
      (d / 2 == 0 ? quad.x : d / 2 == 1 ? quad.y : quad.z) = plane;
      for (std::uint32_t n = rng.below(4); n > 0; --n) out.quads.push_back(pack(quad));
    }
  }
  out.first.back() = static_cast<std::uint32_t>(out.quads.size());
  return out;
}

double plane_of(const QuadFields& quad) {
  const auto d = static_cast<int>(quad.direction);
  return (d / 2 == 0 ? quad.x : d / 2 == 1 ? quad.y : quad.z) + d % 2;
}

bool faces(const QuadFields& quad, const std::array<double, 3>& eye) {
  const auto d = static_cast<int>(quad.direction);
  const double at = eye[static_cast<std::size_t>(d / 2)];
  return d % 2 == 1 ? at > plane_of(quad) : at < plane_of(quad);
}

std::vector<std::uint32_t> quads_of(const std::vector<QuadSpan>& spans) {
  std::vector<std::uint32_t> out;
  for (const QuadSpan& span : spans) {
    for (std::uint32_t i = 0; i < span.count; ++i) out.push_back(span.first + i);
  }
  return out;
}

}  // namespace

TEST_CASE("every quad that faces the eye is drawn once, and at most one plane more a direction",
          "[render]") {
  SplitMix64 rng(3);
  for (int step = 0; step < 300; ++step) {
    const QuadLayers layers = random_layers(rng);
    constexpr std::uint32_t kFirst = 1000;
    const QuadSpans spans(layers, kEdge, kFirst);
    std::array<double, 3> eye{};
    for (double& v : eye) v = static_cast<double>(rng.below(400)) / 10 - 12;
    std::vector<QuadSpan> drawn;
    spans.append_facing(eye, drawn);
    std::vector<std::uint32_t> numbers = quads_of(drawn);
    std::sort(numbers.begin(), numbers.end());
    REQUIRE(std::adjacent_find(numbers.begin(), numbers.end()) == numbers.end());
    for (std::uint32_t i = 0; i < layers.quads.size(); ++i) {
      const QuadFields quad = unpack(layers.quads[i]);
      const bool is_drawn = std::binary_search(numbers.begin(), numbers.end(), kFirst + i);
      if (faces(quad, eye)) REQUIRE(is_drawn);
      const double at = eye[static_cast<std::size_t>(quad.direction) / 2];
      if (is_drawn && !faces(quad, eye)) REQUIRE(std::abs(at - plane_of(quad)) <= 1);
    }
  }
}

TEST_CASE("planes of one axis are drawn from the farthest to the nearest", "[render]") {
  SplitMix64 rng(5);
  const QuadLayers layers = random_layers(rng);
  const QuadSpans spans(layers, kEdge, 0);
  const std::array<double, 3> eye = {7.3, -4, 30};
  std::vector<QuadSpan> drawn;
  spans.append_back_to_front(eye, drawn);
  const std::vector<std::uint32_t> numbers = quads_of(drawn);
  REQUIRE(numbers.size() == layers.quads.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double before = 1e9;
    for (const std::uint32_t i : numbers) {
      const QuadFields quad = unpack(layers.quads[i]);
      if (static_cast<std::size_t>(quad.direction) / 2 != axis) continue;
      const double distance = std::abs(eye[axis] - plane_of(quad));
      REQUIRE(distance <= before);
      before = distance;
    }
  }
}

TEST_CASE("a pass without quads has no spans", "[render]") {
  const QuadSpans spans(QuadLayers{}, kEdge, 5);
  std::vector<QuadSpan> drawn;
  spans.append_facing({1, 2, 3}, drawn);
  spans.append_back_to_front({1, 2, 3}, drawn);
  CHECK(drawn.empty());
  CHECK(spans.all().count == 0);
}
