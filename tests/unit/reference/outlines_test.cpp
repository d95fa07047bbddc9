// Outlines of small drawings by hand, and of random ones compared with the faces around each point.
#include "tests/reference/outlines.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "tests/support/mesh/face_text.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

using namespace reference;

Outlines outlines_of(const std::vector<std::string>& rows) {
  Outlines out;
  OutlineTracer tracer;
  tracer.trace(face_plane(rows), out);
  return out;
}

/// Returns the number of corners of each ring, region by region.
std::vector<std::uint32_t> ring_sizes(const Outlines& outlines) {
  std::vector<std::uint32_t> out;
  for (const auto& ring : outlines.rings) out.push_back(ring.count);
  return out;
}

using Sizes = std::vector<std::uint32_t>;

TEST_CASE("a region is a ring of its corners, and one for each hole", "[mesh][reference]") {
  const Outlines box = outlines_of({"....", ".##.", ".##."});
  CHECK(ring_sizes(box) == Sizes{4});
  CHECK(box.points == std::vector<LayerPoint>{{1, 1}, {3, 1}, {3, 3}, {1, 3}});
  CHECK(box.regions.front().material == kStone);
  CHECK(ring_sizes(outlines_of({"###", "#..", "###"})) == Sizes{8});

  const Outlines frame = outlines_of({"####", "#..#", "#..#", "####"});
  CHECK(frame.regions.size() == 1);
  CHECK(ring_sizes(frame) == Sizes{4, 4});
  // Clockwise.
  CHECK(std::vector<LayerPoint>(frame.points.begin() + 4, frame.points.end()) ==
        std::vector<LayerPoint>{{1, 3}, {3, 3}, {3, 1}, {1, 1}});
  CHECK(outlines_of({"...", "..."}).regions.empty());
}

TEST_CASE("materials are regions of their own, and so are faces that meet at a corner only",
          "[mesh][reference]") {
  const Outlines two = outlines_of({"##++", "##++"});
  CHECK(two.regions.size() == 2);
  CHECK(ring_sizes(two) == Sizes{4, 4});
  const Outlines apart = outlines_of({"#.", ".#"});
  CHECK(apart.regions.size() == 2);
  CHECK(apart.regions[0].touching == 0);
  CHECK(ring_sizes(outlines_of({"#+#", "+#+"})) == Sizes{4, 4, 4, 4, 4, 4});
}

TEST_CASE("a ring passes a corner where its region touches itself twice", "[mesh][reference]") {
  // A hole that touches the outline at a corner becomes part of it.
  const Outlines pocket = outlines_of({"###", "#.#", "##."});
  CHECK(pocket.regions.size() == 1);
  CHECK(pocket.regions[0].touching == 1);
  CHECK(ring_sizes(pocket) == Sizes{10});
  CHECK(std::count(pocket.points.begin(), pocket.points.end(), LayerPoint{2, 2}) == 2);
  // Two holes that touch each other are one.
  const Outlines holes = outlines_of({"####", "#.##", "##.#", "####"});
  CHECK(holes.regions[0].touching == 1);
  CHECK(ring_sizes(holes) == Sizes{4, 8});
  // Both in one region.
  CHECK(outlines_of({"####", "#.##", "##.#", "###."}).regions[0].touching == 2);
}

/// Returns the regions, found by joining faces side by side, each as the set of its faces.
std::vector<std::set<std::pair<int, int>>> regions_of(const FacePlane& plane) {
  const auto width = static_cast<int>(plane.width), height = static_cast<int>(plane.height);
  const auto face = [&](int u, int v) {
    return u < width && v < height ? plane.row(static_cast<std::uint32_t>(v))[u] : kEmpty;
  };
  const auto at = [&width](int u, int v) { return static_cast<std::size_t>(v * width + u); };
  std::vector<std::size_t> root(at(0, height));
  std::iota(root.begin(), root.end(), std::size_t{0});
  const std::function<std::size_t(std::size_t)> find = [&](std::size_t i) {
    return root[i] == i ? i : root[i] = find(root[i]);
  };
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      if (face(u, v) == face(u + 1, v) && face(u, v) != kEmpty)
        root[find(at(u, v))] = find(at(u + 1, v));
      if (face(u, v) == face(u, v + 1) && face(u, v) != kEmpty)
        root[find(at(u, v))] = find(at(u, v + 1));
    }
  }
  std::map<std::size_t, std::set<std::pair<int, int>>> faces;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      if (face(u, v) != kEmpty) faces[find(at(u, v))].insert({u, v});
    }
  }
  std::vector<std::set<std::pair<int, int>>> out;
  for (const auto& [id, region] : faces) out.push_back(region);
  return out;
}

TEST_CASE("outlines of random pictures bound their regions", "[mesh][reference]") {
  SplitMix64 rng(61);
  OutlineTracer tracer;
  Outlines outlines;
  std::uint32_t touching_met = 0;
  std::size_t holes_met = 0;
  for (int round = 0; round < 1500; ++round) {
    const auto rows = random_face_text(rng, round % 10 == 0 ? 40 : 10);
    const FacePlane plane = face_plane(rows);
    tracer.trace(plane, outlines);
    auto regions = regions_of(plane);
    CAPTURE(round, rows);
    REQUIRE(outlines.regions.size() == regions.size());
    for (const Outlines::Region& region : outlines.regions) {
      // The lowest face of the region lies above the first side.
      const LayerPoint first = outlines.points[outlines.rings[region.first_ring].first];
      const auto faces = std::find_if(regions.begin(), regions.end(), [&](const auto& r) {
        return r.count({first.u, first.v}) != 0;
      });
      REQUIRE(faces != regions.end());
      const auto in = [&faces](int u, int v) { return faces->count({u, v}) != 0; };
      REQUIRE(region.material == plane.row(first.v)[first.u]);

      // Unit sides of the rings, and of the faces: the face on the left, none on the right.
      std::multiset<std::array<int, 4>> run;
      std::map<std::pair<int, int>, int> corners;
      int area = 0;
      for (std::uint32_t r = 0; r < region.ring_count; ++r) {
        const Outlines::Ring& ring = outlines.rings[region.first_ring + r];
        int ring_area = 0;
        for (std::uint32_t i = 0; i < ring.count; ++i) {
          const LayerPoint a = outlines.points[ring.first + i];
          const LayerPoint b = outlines.points[ring.first + (i + 1) % ring.count];
          REQUIRE((a.u == b.u) != (a.v == b.v));
          REQUIRE((a.u == b.u) == (i % 2 == 1));
          ++corners[{a.u, a.v}];
          ring_area += a.u * b.v - a.v * b.u;
          const int du = (b.u > a.u) - (b.u < a.u), dv = (b.v > a.v) - (b.v < a.v);
          for (int u = a.u, v = a.v; u != b.u || v != b.v; u += du, v += dv)
            run.insert({u, v, du, dv});
        }
        REQUIRE((ring_area > 0) == (r == 0));  // the outer ring alone runs counter-clockwise
        area += ring_area;
      }
      REQUIRE(area == 2 * static_cast<int>(faces->size()));
      std::multiset<std::array<int, 4>> owed;
      for (const auto& [u, v] : *faces) {
        if (!in(u, v - 1)) owed.insert({u, v, 1, 0});
        if (!in(u + 1, v)) owed.insert({u + 1, v, 0, 1});
        if (!in(u, v + 1)) owed.insert({u + 1, v + 1, -1, 0});
        if (!in(u - 1, v)) owed.insert({u, v + 1, 0, -1});
      }
      REQUIRE(run == owed);

      // A corner has one or three faces of the region around it, or two on a diagonal. Then the
      // ring passes it twice.
      std::map<std::pair<int, int>, int> corners_owed;
      std::uint32_t touching = 0;
      for (int v = 0; v <= static_cast<int>(plane.height); ++v) {
        for (int u = 0; u <= static_cast<int>(plane.width); ++u) {
          const bool a = in(u - 1, v - 1), b = in(u, v - 1), c = in(u - 1, v), d = in(u, v);
          const int around = a + b + c + d;
          if (around == 1 || around == 3) corners_owed[{u, v}] = 1;
          if (around == 2 && a == d) {
            corners_owed[{u, v}] = 2;
            ++touching;
          }
        }
      }
      REQUIRE(corners == corners_owed);
      REQUIRE(region.touching == touching);
      touching_met += touching;
      holes_met += region.ring_count - 1;
    }
  }
  CHECK(touching_met > 200);
  CHECK(holes_met > 200);
}

}  // namespace
}  // namespace runstone::test
