// Triangulations of regions: their size, their points, their sides, and the Delaunay property.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "tests/reference/monotone_triangulation.hpp"
#include "tests/reference/sweep_delaunay.hpp"
#include "tests/reference/t_junctions.hpp"
#include "tests/support/mesh/face_text.hpp"

namespace runstone::test {
namespace {

using namespace reference;
using Point = std::pair<int, int>;

std::vector<Point> ring_of(const Outlines& outlines, const Outlines::Ring& ring) {
  std::vector<Point> out;
  for (std::uint32_t i = 0; i < ring.count; ++i) {
    const LayerPoint p = outlines.points[ring.first + i];
    out.push_back({p.u, p.v});
  }
  return out;
}

/// Returns directed sides, with the region on the left.
std::set<std::pair<Point, Point>> sides_of(const Outlines& outlines,
                                           const Outlines::Region& region) {
  std::set<std::pair<Point, Point>> out;
  for (std::uint32_t r = 0; r < region.ring_count; ++r) {
    const auto ring = ring_of(outlines, outlines.rings[region.first_ring + r]);
    for (std::size_t i = 0; i < ring.size(); ++i)
      out.insert({ring[i], ring[(i + 1) % ring.size()]});
  }
  return out;
}

/// A second implementation beside layer_point.hpp: the determinant with the lifted points, in long
/// double.
long double in_circumcircle(Point a, Point b, Point c, Point d) {
  const auto x = [](Point p) { return static_cast<long double>(p.first); };
  const auto y = [](Point p) { return static_cast<long double>(p.second); };
  const auto l = [&](Point p) { return x(p) * x(p) + y(p) * y(p); };
  const auto minor = [&](Point p, Point q, Point r) {
    return x(p) * (y(q) * l(r) - y(r) * l(q)) - y(p) * (x(q) * l(r) - x(r) * l(q)) +
           l(p) * (x(q) * y(r) - x(r) * y(q));
  };
  return minor(a, b, c) - minor(b, c, d) + minor(a, c, d) - minor(a, b, d);
}

struct Judged {
  std::string fault;
  std::size_t free_edges = 0, bad_edges = 0;  // within the region; not Delaunay
};

/// Checks the triangles of a region: their number follows from corners and holes, all points are
/// used, and every side is an edge.
template <class Triangulation>
Judged judge(const Outlines& outlines, const Outlines::Region& region,
             const Triangulation& triangulation) {
  Judged out;
  const auto sides = sides_of(outlines, region);
  std::vector<Point> points;
  for (const LayerPoint& p : triangulation.points()) points.push_back({p.u, p.v});
  std::set<Point> corners;
  for (const auto& side : sides) corners.insert(side.first);
  if (points.size() != corners.size() || std::set<Point>(points.begin(), points.end()) != corners) {
    return {"the points are not the corners"};
  }
  std::map<std::pair<Point, Point>, Point> edges;  // directed, with the third point
  Surface surface;
  for (const auto& [u, v] : points)
    surface.triangles.vertices.push_back(
        {static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(v), 0});
  for (const auto& t : triangulation.triangles()) {
    surface.triangles.triangles.push_back({t, Direction::pos_z, 1});
    for (std::size_t i = 0; i < 3; ++i) {
      const auto edge = std::pair(points[t[i]], points[t[(i + 1) % 3]]);
      if (!edges.emplace(edge, points[t[(i + 2) % 3]]).second)
        return {"an edge has two triangles on its left"};
    }
  }
  if (count_t_junctions(surface).places != 0) return {"a T-junction within a region"};
  // Passages of corners minus 2, plus 2 for each inner ring.
  std::size_t passages = 0;
  for (std::uint32_t r = 0; r < region.ring_count; ++r)
    passages += outlines.rings[region.first_ring + r].count;
  if (triangulation.triangles().size() != passages - 2 + 2 * (region.ring_count - 1))
    return {"the number of triangles"};
  for (const auto& side : sides) {
    if (edges.count(side) == 0) return {"a side is no edge"};
    if (edges.count({side.second, side.first}) != 0) return {"a triangle beyond a side"};
  }
  for (const auto& [edge, apex] : edges) {
    if (sides.count(edge) != 0) continue;
    const auto twin = edges.find({edge.second, edge.first});
    if (twin == edges.end()) return {"an edge that is no side has one triangle"};
    ++out.free_edges;
    out.bad_edges += in_circumcircle(edge.first, edge.second, apex, twin->second) > 0 ? 1 : 0;
  }
  return out;
}

TEST_CASE("regions of random pictures: exact triangulations, and the Delaunay one is",
          "[mesh][reference]") {
  SplitMix64 rng(71);
  OutlineTracer tracer;
  Outlines outlines;
  MonotoneTriangulation monotone;
  SweepDelaunay delaunay;
  std::size_t touching = 0, holes = 0, free_edges = 0, bad_monotone = 0;
  for (int round = 0; round < 1500; ++round) {
    const auto rows = random_face_text(rng, round % 100 == 0 ? 128 : round % 10 == 0 ? 40 : 12);
    tracer.trace(face_plane(rows), outlines);
    for (const Outlines::Region& region : outlines.regions) {
      CAPTURE(round, rows);
      monotone.run(outlines, region);
      const Judged cut = judge(outlines, region, monotone);
      REQUIRE(cut.fault == "");
      bad_monotone += cut.bad_edges;
      delaunay.run(outlines, region);
      const Judged best = judge(outlines, region, delaunay);
      REQUIRE(best.fault == "");
      REQUIRE(best.bad_edges == 0);
      free_edges += best.free_edges;
      touching += region.touching;
      holes += region.ring_count - 1;
    }
  }
  CHECK(touching > 400);
  CHECK(holes > 400);
  CHECK(bad_monotone > free_edges / 20);  // otherwise the property would prove nothing
}

TEST_CASE("a comb and a spiral, whose corners lie in few rows and columns", "[mesh][reference]") {
  OutlineTracer tracer;
  Outlines outlines;
  MonotoneTriangulation monotone;
  SweepDelaunay delaunay;
  std::vector<std::string> comb(128, std::string(128, '.'));
  std::vector<std::string> spiral = comb;
  for (std::size_t v = 0; v < 128; ++v) {
    for (std::size_t u = 0; u < 128; ++u) {
      if (v == 64 || u % 2 == 0) comb[v][u] = '#';
    }
  }
  int u = 0, v = 0, du = 1, dv = 0;
  const auto taken = [&spiral](int at_u, int at_v) {
    return at_u >= 0 && at_u < 128 && at_v >= 0 && at_v < 128 &&
           spiral[static_cast<std::size_t>(at_v)][static_cast<std::size_t>(at_u)] == '#';
  };
  for (int turns = 0; turns < 2;) {
    spiral[static_cast<std::size_t>(v)][static_cast<std::size_t>(u)] = '#';
    const bool blocked = u + du < 0 || u + du > 127 || v + dv < 0 || v + dv > 127 ||
                         taken(u + du, v + dv) || taken(u + 2 * du, v + 2 * dv);
    if (blocked) {
      std::swap(du, dv);
      du = -du;
      ++turns;
      continue;
    }
    turns = 0;
    u += du;
    v += dv;
  }
  for (const auto& picture : {comb, spiral}) {
    tracer.trace(face_plane(picture), outlines);
    REQUIRE(outlines.regions.size() == 1);
    CHECK(outlines.points.size() > 100);
    monotone.run(outlines, outlines.regions[0]);
    CHECK(judge(outlines, outlines.regions[0], monotone).fault == "");
    delaunay.run(outlines, outlines.regions[0]);
    const Judged best = judge(outlines, outlines.regions[0], delaunay);
    CHECK(best.fault == "");
    CHECK(best.bad_edges == 0);
  }
}

TEST_CASE("exact predicates at the largest coordinates", "[mesh][reference]") {
  CHECK(turn({0, 0}, {128, 0}, {0, 128}) == 128 * 128);
  CHECK(turn({0, 0}, {128, 128}, {64, 64}) == 0);
  CHECK(turn({0, 0}, {128, 127}, {127, 126}) == -1);
  CHECK(in_circle({0, 0}, {128, 0}, {0, 128}, {128, 128}) == 0);
  CHECK(in_circle({0, 0}, {128, 0}, {0, 128}, {127, 128}) > 0);
  CHECK(in_circle({0, 0}, {127, 0}, {0, 127}, {128, 128}) < 0);
}

}  // namespace
}  // namespace runstone::test
