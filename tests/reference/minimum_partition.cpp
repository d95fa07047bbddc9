#include "tests/reference/minimum_partition.hpp"

#include <algorithm>

namespace runstone::reference {
namespace {

// The flags of the edge from a corner to the next one, by Line.
constexpr std::array<std::uint8_t, 2> kWall = {1, 2};
constexpr std::uint8_t kConcave = 4;
constexpr std::uint8_t kServed = 8;  // a chord of the set ends here

/// Returns true if exactly three of the four faces around a corner have one material: two faces
/// across the corner are equal, and one of the others has their material too.
bool turns_inwards(Material a, Material b, Material c, Material d) {
  if (a == d) return a != kEmpty && (b == a) != (c == a);
  return b == c && b != kEmpty && (a == b) != (d == b);
}

}  // namespace

void MinimumPartition::find(const FacePlane& plane, std::vector<PlaneRectangle>& out) {
  find_corners(plane);
  find_chords(along_u);
  find_chords(along_v);
  cut_chords();
  cut_from_corners_left();
  read_off(plane, out);
}

/// Walls lie between faces of different material and at the plane's border.
void MinimumPartition::find_corners(const FacePlane& plane) {
  step_ = {1, static_cast<std::size_t>(plane.width) + 1};
  corners_.assign(step_[along_v] * (plane.height + 1), 0);
  // -1 wraps to a number beyond the width.
  const auto face = [&plane](std::uint32_t u, std::uint32_t v) {
    return u < plane.width && v < plane.height ? plane.row(v)[u] : kEmpty;
  };
  auto corner = corners_.begin();
  for (std::uint32_t v = 0; v <= plane.height; ++v) {
    for (std::uint32_t u = 0; u <= plane.width; ++u, ++corner) {
      const Material here = face(u, v);
      const Material before = face(u - 1, v);
      const Material above = face(u, v - 1);
      unsigned marks = turns_inwards(face(u - 1, v - 1), above, before, here) ? kConcave : 0u;
      if (here != above) marks |= kWall[along_u];
      if (here != before) marks |= kWall[along_v];
      *corner = static_cast<std::uint8_t>(marks);
    }
  }
}

/// Returns true if the edge from a corner to the next one is a wall.
bool MinimumPartition::is_wall(std::size_t corner, Line line) const {
  return (corners_[corner] & kWall[line]) != 0;
}

/// Returns true if a wall meets `line` at a corner from either side. Inside a shape a cut ends
/// there.
bool MinimumPartition::is_crossed(std::size_t corner, Line line) const {
  const Line across = line == along_u ? along_v : along_u;
  return is_wall(corner, across) || is_wall(corner - step_[across], across);
}

void MinimumPartition::cut(std::size_t from, std::size_t to, Line line) {
  for (; from != to; from += step_[line]) corners_[from] |= kWall[line];
}

/// A chord leads through the inside from one concave corner to another. Each corner has one chord
/// along u and one along v at most, so chords of one line share no corners.
void MinimumPartition::find_chords(Line line) {
  chords_[line].clear();
  for (std::size_t from = 0; from < corners_.size(); ++from) {
    if ((corners_[from] & kConcave) == 0 || is_wall(from, line)) continue;
    std::size_t to = from;
    do to += step_[line];
    while (!is_crossed(to, line));
    if ((corners_[to] & kConcave) != 0) chords_[line].push_back({from, to});
  }
}

void MinimumPartition::cut_chords() {
  chord_at_.assign(corners_.size(), 0);
  for (std::uint32_t i = 0; i < chords_[along_v].size(); ++i) {
    const Chord& chord = chords_[along_v][i];
    for (std::size_t at = chord.from; at <= chord.to; at += step_[along_v]) chord_at_[at] = i + 1;
  }
  meetings_.clear();
  meetings_.right_count = static_cast<std::uint32_t>(chords_[along_v].size());
  for (const Chord& chord : chords_[along_u]) {
    for (std::size_t at = chord.from; at <= chord.to; ++at) {
      if (chord_at_[at] != 0) meetings_.edges.push_back(chord_at_[at] - 1);
    }
    meetings_.end_left();
  }
  taken_.find(meetings_);
  for (const Line line : {along_u, along_v}) {
    for (std::uint32_t i = 0; i < chords_[line].size(); ++i) {
      if (!(line == along_u ? taken_.has_left(i) : taken_.has_right(i))) continue;
      const auto [from, to] = chords_[line][i];
      cut(from, to, line);
      corners_[from] |= kServed;
      corners_[to] |= kServed;
    }
  }
}

/// Cuts along u, away from the outline, to the first wall.
void MinimumPartition::cut_from_corners_left() {
  for (std::size_t corner = 0; corner < corners_.size(); ++corner) {
    if ((corners_[corner] & (kConcave | kServed)) != kConcave) continue;
    std::size_t end = corner;
    if (is_wall(corner, along_u)) {
      do --end;
      while (!is_crossed(end, along_u));
      cut(end, corner, along_u);
    } else {
      do ++end;
      while (!is_crossed(end, along_u));
      cut(corner, end, along_u);
    }
  }
}

/// Reads the rectangles: there are no other shapes between walls now.
void MinimumPartition::read_off(const FacePlane& plane, std::vector<PlaneRectangle>& out) {
  out.clear();
  covered_.assign(plane.faces.size(), 0);
  for (std::uint32_t v = 0; v < plane.height; ++v) {
    for (std::uint32_t u = 0; u < plane.width; ++u) {
      const std::size_t face = static_cast<std::size_t>(v) * plane.width + u;
      if (plane.faces[face] == kEmpty || covered_[face] != 0) continue;
      const std::size_t corner = v * step_[along_v] + u;
      PlaneRectangle r{u, v, 1, 1, plane.faces[face]};
      while (!is_wall(corner + r.width, along_v)) ++r.width;
      while (!is_wall(corner + r.height * step_[along_v], along_u)) ++r.height;
      for (std::uint32_t row = 0; row < r.height; ++row) {
        std::fill_n(covered_.begin() + static_cast<std::ptrdiff_t>(face + row * plane.width),
                    r.width, std::uint8_t{1});
      }
      out.push_back(r);
    }
  }
}

}  // namespace runstone::reference
