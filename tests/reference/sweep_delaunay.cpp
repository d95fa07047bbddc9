#include "tests/reference/sweep_delaunay.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone::reference {

void SweepDelaunay::run(const Outlines& outlines, const Outlines::Region& region) {
  sweep_.read(outlines, region);
  const std::size_t count = sweep_.points.size();
  from_.clear();
  twin_.clear();
  side_.clear();
  edge_of_.assign(count, kNone);
  hull_next_.assign(count, kNone);
  hull_prev_.assign(count, kNone);
  hull_edge_.assign(count, kNone);

  const std::size_t row = first_row();
  std::size_t corner = 0;
  for (PointId point = static_cast<PointId>(row); point < count; ++point) {
    point == row ? start_front(row) : point_event(point);
    restore();
    // A side is added with its upper end; the sides of the first row with the first point above it.
    for (; corner < sweep_.corners.size() && sweep_.corners[corner].point <= point; ++corner) {
      const auto [upper, before, after] = sweep_.corners[corner];
      if (before < corner) edge_event(sweep_.corners[before].point, upper);
      if (after < corner) edge_event(upper, sweep_.corners[after].point);
    }
  }
  keep_inner();
}

SweepDelaunay::EdgeId SweepDelaunay::add_triangle(PointId a, PointId b, PointId c) {
  const auto e = static_cast<EdgeId>(from_.size());
  from_.insert(from_.end(), {a, b, c});
  twin_.insert(twin_.end(), 3, kNone);
  side_.insert(side_.end(), 3, Side::free);
  edge_of_[a] = e;
  edge_of_[b] = e + 1;
  edge_of_[c] = e + 2;
  return e;
}

void SweepDelaunay::join(EdgeId e, EdgeId twin) {
  twin_[e] = twin;
  twin_[twin] = e;
  side_[e] = side_[twin] == Side::inner   ? Side::outer
             : side_[twin] == Side::outer ? Side::inner
                                          : Side::free;
}

void SweepDelaunay::set_hull(PointId from, PointId to, EdgeId edge) {
  hull_next_[from] = to;
  hull_prev_[to] = from;
  hull_edge_[from] = edge;
}

/// Returns the number of points in the lowest row: two or more, since it contains a side of the
/// region.
std::size_t SweepDelaunay::first_row() const {
  const auto& points = sweep_.points;
  const auto above = std::find_if(points.begin(), points.end(),
                                  [&](const LayerPoint& p) { return p.v != points.front().v; });
  RUNSTONE_ASSERT(above - points.begin() >= 2 && above != points.end());
  return static_cast<std::size_t>(above - points.begin());
}

/// Makes a fan from the first point above the lowest row.
void SweepDelaunay::start_front(std::size_t row) {
  const auto top = static_cast<PointId>(row);
  for (PointId a = 0; a + 1 < top; ++a) {
    const EdgeId e = add_triangle(a, a + 1, top);
    set_hull(a, a + 1, e);
    if (a > 0) {
      join(e + 2, e - 2);
      doubtful_.push_back(e + 2);
    }
  }
  set_hull(top - 1, top, static_cast<EdgeId>(from_.size() - 2));
  set_hull(top, 0, 2);
}

/// Joins a point to all points of the hull that it sees, starting from the point before it, which
/// is the highest.
void SweepDelaunay::point_event(PointId point) {
  const auto seen = [&](PointId from) {
    return turn(at(from), at(hull_next_[from]), at(point)) < 0;
  };
  PointId first = point - 1;
  PointId last = first;
  while (seen(last)) last = hull_next_[last];
  while (seen(hull_prev_[first])) first = hull_prev_[first];
  RUNSTONE_ASSERT(first != last);

  EdgeId rising = kNone;  // of the previous triangle: from the hull up to the point
  EdgeId falling = kNone;
  for (PointId a = first; a != last; a = hull_next_[a]) {
    const EdgeId hull = hull_edge_[a];
    const EdgeId e = add_triangle(hull_next_[a], a, point);
    join(e, hull);
    doubtful_.push_back(e);
    if (a == first) {
      rising = e + 1;
    } else {
      join(e + 1, falling);
      doubtful_.push_back(e + 1);
    }
    falling = e + 2;
  }
  set_hull(first, point, rising);
  set_hull(point, last, falling);
}

/// Makes the side from -> to an edge, with the region on its left.
void SweepDelaunay::edge_event(PointId from, PointId to) {
  if (edge_between(from, to) == kNone && edge_between(to, from) == kNone) {
    cross(from, to);
  } else {
    mark(from, to);
  }
}

void SweepDelaunay::mark(PointId from, PointId to) {
  const EdgeId inner = edge_between(from, to);
  const EdgeId outer = edge_between(to, from);
  if (inner != kNone) side_[inner] = Side::inner;
  if (outer != kNone) side_[outer] = Side::outer;
}

/// Flips away the edges across a side that is no edge yet (Sloan 1993), then restores the edges
/// around it.
void SweepDelaunay::cross(PointId from, PointId to) {
  crossed_.clear();
  fresh_.clear();
  // The edge leads from the right of the side to its left, like all that follow.
  EdgeId e = edge_across(from, to);
  crossed_.push_back({from_[e], end_of(e)});
  for (PointId apex = apex_of(twin_[e]); apex != to; apex = apex_of(twin_[e])) {
    e = turn(at(from), at(to), at(apex)) > 0 ? next(twin_[e]) : previous(twin_[e]);
    crossed_.push_back({from_[e], end_of(e)});
  }
  for (std::size_t i = 0; i < crossed_.size(); ++i) {
    e = edge_between(crossed_[i][0], crossed_[i][1]);
    if (!convex(e)) {  // it becomes convex when others are flipped
      crossed_.push_back(crossed_[i]);
      continue;
    }
    flip(e);
    const std::array<PointId, 2> ends = {from_[e], end_of(e)};
    const auto side_of = [&](PointId p) { return turn(at(from), at(to), at(p)); };
    const bool crosses = (side_of(ends[0]) < 0) != (side_of(ends[1]) < 0) &&
                         side_of(ends[0]) != 0 && side_of(ends[1]) != 0;
    (crosses ? crossed_ : fresh_).push_back(ends);
  }
  mark(from, to);
  for (const auto& [a, b] : fresh_) {
    e = edge_between(a, b);
    doubtful_.push_back(e == kNone ? edge_between(b, a) : e);
  }
  restore();
}

/// Returns the edge in this direction, or kNone. On the hull an edge has one direction only.
SweepDelaunay::EdgeId SweepDelaunay::edge_between(PointId from, PointId to) const {
  EdgeId found = kNone;
  each_edge_from(from, [&](EdgeId e) {
    if (end_of(e) == to) found = e;
  });
  return found;
}

/// Returns the edge opposite to `from` in the triangle through which the line to `to` leads.
SweepDelaunay::EdgeId SweepDelaunay::edge_across(PointId from, PointId to) const {
  EdgeId found = kNone;
  each_edge_from(from, [&](EdgeId e) {
    if (turn(at(from), at(to), at(end_of(e))) < 0 && turn(at(from), at(to), at(apex_of(e))) > 0)
      found = next(e);
  });
  RUNSTONE_ASSERT(found != kNone);
  return found;
}

/// Calls visit(edge) for each edge that starts in a point, turning left until the hull or a full
/// turn, then right.
template <class F>
void SweepDelaunay::each_edge_from(PointId from, F&& visit) const {
  const EdgeId first = edge_of_[from];
  EdgeId e = first;
  do {
    visit(e);
    e = twin_[previous(e)];
  } while (e != kNone && e != first);
  if (e == first) return;
  for (e = twin_[first]; e != kNone; e = twin_[e]) {
    e = next(e);
    visit(e);
  }
}

/// Returns true if the two triangles of an edge are a convex polygon, without a straight corner at
/// its ends.
bool SweepDelaunay::convex(EdgeId e) const {
  const LayerPoint a = at(from_[e]), b = at(end_of(e)), c = at(apex_of(e)),
                   d = at(apex_of(twin_[e]));
  return turn(c, a, d) > 0 && turn(d, b, c) > 0;
}

/// Flips an edge: the triangles a b c and b a d become d c a and c d b. The edge keeps its index,
/// the four around it move by one.
void SweepDelaunay::flip(EdgeId e) {
  const EdgeId f = twin_[e];
  const std::array<EdgeId, 4> around = {next(e), previous(e), next(f), previous(f)};
  const std::array<PointId, 4> starts = {from_[around[1]], from_[e], from_[around[3]],
                                         from_[f]};  // c a d b
  const EdgeId twin_first = twin_[around[0]];
  const Side side_first = side_[around[0]];
  for (std::size_t i = 0; i < 4; ++i) {
    const EdgeId to = around[i];
    twin_[to] = i < 3 ? twin_[around[i + 1]] : twin_first;
    side_[to] = i < 3 ? side_[around[i + 1]] : side_first;
    from_[to] = starts[i];
  }
  from_[e] = starts[2];
  from_[f] = starts[0];
  for (const EdgeId to : around) {
    edge_of_[from_[to]] = to;
    if (twin_[to] == kNone) {
      hull_edge_[from_[to]] = to;
    } else {
      twin_[twin_[to]] = to;
    }
  }
}

/// Flips until every doubtful edge that is no side has the Delaunay property (Lawson 1977).
void SweepDelaunay::restore() {
  while (!doubtful_.empty()) {
    const EdgeId e = doubtful_.back();
    doubtful_.pop_back();
    if (twin_[e] == kNone || side_[e] != Side::free) continue;
    if (in_circle(at(from_[e]), at(end_of(e)), at(apex_of(e)), at(apex_of(twin_[e]))) <= 0)
      continue;
    flip(e);
    for (const EdgeId half : {e, twin_[e]}) {
      doubtful_.push_back(next(half));
      doubtful_.push_back(previous(half));
    }
  }
}

/// Takes the triangles within the region: from its sides inwards as far as there is no side.
void SweepDelaunay::keep_inner() {
  triangles_.clear();
  kept_.assign(from_.size() / 3, 0);
  doubtful_.clear();
  const auto keep = [this](EdgeId e) {
    if (kept_[e / 3] != 0) return;
    kept_[e / 3] = 1;
    for (const EdgeId edge : {e, next(e), previous(e)}) {
      if (side_[edge] == Side::free) doubtful_.push_back(twin_[edge]);
    }
  };
  for (EdgeId e = 0; e < from_.size(); ++e) {
    if (side_[e] == Side::inner) keep(e);
  }
  while (!doubtful_.empty()) {
    const EdgeId e = doubtful_.back();
    doubtful_.pop_back();
    keep(e);
  }
  for (std::size_t t = 0; t < kept_.size(); ++t) {
    if (kept_[t] != 0) triangles_.push_back({from_[3 * t], from_[3 * t + 1], from_[3 * t + 2]});
  }
}

}  // namespace runstone::reference
