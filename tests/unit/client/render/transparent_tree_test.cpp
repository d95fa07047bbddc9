#include "client/render/transparent_tree.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "common/core/hash.hpp"

using namespace runstone;

namespace {

using Place = std::array<double, 3>;

/// Returns the distance along a ray at which it meets a quad, or a negative number.
double meets(const QuadFields& q, const Place& eye, const Place& ray) {
  const auto axis = static_cast<std::size_t>(axis_of(q.direction));
  const Place corner = {1.0 * q.x, 1.0 * q.y, 1.0 * q.z};
  const double plane = corner[axis] + (is_positive(q.direction) ? 1 : 0);
  const double at = (plane - eye[axis]) / ray[axis];
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double pu = eye[u] + at * ray[u] - corner[u], pv = eye[v] + at * ray[v] - corner[v];
  return pu > 0 && pu < q.width && pv > 0 && pv < q.height ? at : -1;
}

/// Returns the quads in the order in which they are drawn.
std::vector<QuadFields> drawn_from(const TransparentTree& tree, const Place& eye) {
  std::vector<QuadSpan> spans;
  tree.append_back_to_front(eye, 100, spans);
  std::vector<QuadFields> out;
  for (const QuadSpan& span : spans) {
    for (std::uint32_t i = 0; i < span.count; ++i)
      out.push_back(unpack(tree.pieces()[span.first - 100 + i]));
  }
  return out;
}

/// Returns the number of neighbours along random rays that are drawn in the wrong order.
std::size_t wrong_pairs(const std::vector<QuadFields>& drawn, const Place& eye, SplitMix64& rng) {
  std::size_t wrong = 0;
  for (int step = 0; step < 300; ++step) {
    Place ray{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      ray[axis] = rng.below(16'000) / 1000.0 - eye[axis] + 1e-4;
    std::vector<std::pair<double, std::size_t>> met;
    for (std::size_t q = 0; q < drawn.size(); ++q) {
      const double at = meets(drawn[q], eye, ray);
      if (at > 0) met.emplace_back(at, q);
    }
    std::sort(met.begin(), met.end());
    for (std::size_t i = 1; i < met.size(); ++i) {
      if (met[i].first - met[i - 1].first < 1e-9) continue;  // in one plane
      wrong += met[i].second > met[i - 1].second ? 1 : 0;
    }
  }
  return wrong;
}

std::vector<Quad> random_quads(SplitMix64& rng, std::size_t count) {
  std::vector<Quad> out;
  while (out.size() < count) {
    const auto at = [&rng] { return static_cast<std::uint8_t>(rng.below(12)); };
    const auto size = [&rng] { return static_cast<std::uint8_t>(1 + rng.below(5)); };
    out.push_back(pack({at(), at(), at(), size(), size(), static_cast<Direction>(rng.below(6)),
                        static_cast<Material>(1 + rng.below(3))}));
  }
  return out;
}

/// Returns how often each unit face, with its direction and material, is covered.
std::map<std::array<int, 5>, int> unit_faces(std::span<const Quad> quads) {
  std::map<std::array<int, 5>, int> out;
  for (const Quad& quad : quads) {
    const QuadFields q = unpack(quad);
    const auto u = static_cast<std::size_t>(u_axis_of(axis_of(q.direction)));
    const auto v = static_cast<std::size_t>(v_axis_of(axis_of(q.direction)));
    for (int i = 0; i < q.width; ++i) {
      for (int j = 0; j < q.height; ++j) {
        std::array<int, 5> face = {q.x, q.y, q.z, static_cast<int>(q.direction), q.material};
        face[u] += i;
        face[v] += j;
        ++out[face];
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE("transparent quads are drawn from back to front from everywhere, also if they cross",
          "[render]") {
  SplitMix64 rng(3);
  for (int step = 0; step < 40; ++step) {
    const std::vector<Quad> quads = random_quads(rng, 40);
    const auto tree = TransparentTree::build(quads);
    REQUIRE(tree.has_value());
    CHECK(unit_faces(tree->pieces()) == unit_faces(quads));
    for (int place = 0; place < 4; ++place) {
      const auto at = [&rng] { return rng.below(40'000) / 1000.0 - 12 + 1e-4; };
      const Place eye = {at(), at(), at()};
      std::vector<QuadFields> drawn = drawn_from(*tree, eye);
      REQUIRE(drawn.size() == tree->pieces().size());
      CAPTURE(step, place, eye[0], eye[1], eye[2]);
      REQUIRE(wrong_pairs(drawn, eye, rng) == 0);
      // The oracle is broken on purpose: the opposite order is wrong.
      std::reverse(drawn.begin(), drawn.end());
      REQUIRE(wrong_pairs(drawn, eye, rng) > 0);
    }
  }
}

TEST_CASE("a flat surface is one span, and too many quads have no tree", "[render]") {
  std::vector<Quad> surface;
  for (std::uint8_t x = 0; x < 16; ++x) {
    for (std::uint8_t z = 0; z < 16; ++z)
      surface.push_back(pack({x, 7, z, 1, 1, Direction::pos_y, 2}));
  }
  const auto tree = TransparentTree::build(surface);
  REQUIRE(tree.has_value());
  std::vector<QuadSpan> spans;
  tree->append_back_to_front({3, 20, 3}, 0, spans);
  REQUIRE(spans.size() == 1);
  CHECK(spans[0].count == 256);
  CHECK(TransparentTree::build({})->pieces().empty());
  SplitMix64 rng(4);
  CHECK_FALSE(TransparentTree::build(random_quads(rng, TransparentTree::kQuadsMax + 1)));
  // Quads that cross each other everywhere are cut into too many pieces.
  CHECK_FALSE(TransparentTree::build(random_quads(rng, TransparentTree::kQuadsMax)));
}
