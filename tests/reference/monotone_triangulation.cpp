#include "tests/reference/monotone_triangulation.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone::reference {

void MonotoneTriangulation::run(const Outlines& outlines, const Outlines::Region& region) {
  sweep_.read(outlines, region);
  triangles_.clear();
  // The same regions use the same buffers again, which are then large enough.
  piece_count_ = slab_count_ = 0;
  free_pieces_.clear();
  free_slabs_.clear();
  left_of_.assign(sweep_.corners.size(), kNone);
  right_of_.assign(sweep_.corners.size(), kNone);
  for (CornerId corner = 0; corner < sweep_.corners.size(); ++corner) {
    const auto [point, before, after] = sweep_.corners[corner];
    // The region lies on the left of its ring. The ring runs up the region's right sides and down
    // its left ones.
    if (before < corner && after > corner) {
      const SlabId slab = right_of_[corner];
      const PieceId piece = meet_right(slabs_[slab], corner);
      slabs_[slab].left_piece = slabs_[slab].right_piece = piece;
      slabs_[slab].right_end = after;
      right_of_[after] = slab;
      continue;
    }
    if (before > corner && after < corner) {
      const SlabId slab = left_of_[corner];
      const PieceId piece = meet_left(slabs_[slab], corner);
      slabs_[slab].left_piece = slabs_[slab].right_piece = piece;
      slabs_[slab].left_end = before;
      left_of_[before] = slab;
      continue;
    }
    const bool convex = turn(at(before), at(corner), at(after)) > 0;
    if (after > corner) {
      convex ? start(corner) : split(corner);
    } else {
      convex ? end(corner) : merge(corner);
    }
  }
  RUNSTONE_ASSERT(open_slabs_.empty());
}

MonotoneTriangulation::PieceId MonotoneTriangulation::open_piece(CornerId lowest) {
  if (free_pieces_.empty()) {
    if (piece_count_ == pieces_.size()) pieces_.emplace_back();
    free_pieces_.push_back(piece_count_++);
  }
  const PieceId piece = free_pieces_.back();
  free_pieces_.pop_back();
  pieces_[piece].left.assign(1, lowest);
  pieces_[piece].right.assign(1, lowest);
  return piece;
}

void MonotoneTriangulation::close_piece(PieceId piece, CornerId top) {
  pieces_[piece].left.push_back(top);
  pieces_[piece].right.push_back(top);
  triangulate(pieces_[piece]);
  free_pieces_.push_back(piece);
}

MonotoneTriangulation::SlabId MonotoneTriangulation::open_slab(const Slab& slab) {
  if (free_slabs_.empty()) {
    if (slab_count_ == slabs_.size()) slabs_.emplace_back();
    free_slabs_.push_back(slab_count_++);
  }
  const SlabId id = free_slabs_.back();
  free_slabs_.pop_back();
  open_slabs_.push_back(id);
  slabs_[id] = slab;
  left_of_[slab.left_end] = id;
  right_of_[slab.right_end] = id;
  return id;
}

void MonotoneTriangulation::close_slab(SlabId slab) {
  *std::find(open_slabs_.begin(), open_slabs_.end(), slab) = open_slabs_.back();
  open_slabs_.pop_back();
  free_slabs_.push_back(slab);
}

/// Returns the slab that contains a corner. Sides along u are not considered: none crosses the
/// height of a corner that lies within a slab.
MonotoneTriangulation::SlabId MonotoneTriangulation::slab_around(CornerId corner) const {
  const auto inside = [&](SlabId slab) {
    return at(slabs_[slab].left_end).u < at(corner).u &&
           at(corner).u < at(slabs_[slab].right_end).u;
  };
  const auto found = std::find_if(open_slabs_.begin(), open_slabs_.end(), inside);
  RUNSTONE_ASSERT(found != open_slabs_.end());
  return *found;
}

/// Handles a corner on the left side of a slab. Returns the one piece that continues, with the
/// corner on its left chain.
MonotoneTriangulation::PieceId MonotoneTriangulation::meet_left(Slab& slab, CornerId corner) {
  if (slab.left_piece != slab.right_piece) close_piece(slab.left_piece, corner);
  pieces_[slab.right_piece].left.push_back(corner);
  return slab.right_piece;
}

MonotoneTriangulation::PieceId MonotoneTriangulation::meet_right(Slab& slab, CornerId corner) {
  if (slab.left_piece != slab.right_piece) close_piece(slab.right_piece, corner);
  pieces_[slab.left_piece].right.push_back(corner);
  return slab.left_piece;
}

void MonotoneTriangulation::start(CornerId corner) {
  const PieceId piece = open_piece(corner);
  const auto& [point, before, after] = sweep_.corners[corner];
  open_slab({piece, piece, before, after});
}

void MonotoneTriangulation::split(CornerId corner) {
  const SlabId below = slab_around(corner);
  Slab left = slabs_[below];
  Slab right = left;
  close_slab(below);
  if (left.left_piece != left.right_piece) {  // joined with the merging corner
    pieces_[left.left_piece].right.push_back(corner);
    pieces_[right.right_piece].left.push_back(corner);
  } else {
    const PieceId whole = left.left_piece;
    const CornerId on_left = pieces_[whole].left.back();
    const CornerId on_right = pieces_[whole].right.back();
    const PieceId cut = open_piece(std::max(on_left, on_right));
    if (on_left > on_right) {
      pieces_[whole].left.push_back(corner);
      pieces_[cut].right.push_back(corner);
      left.left_piece = cut;
    } else {
      pieces_[whole].right.push_back(corner);
      pieces_[cut].left.push_back(corner);
      right.right_piece = cut;
    }
  }
  left.right_piece = left.left_piece;
  right.left_piece = right.right_piece;
  left.right_end = sweep_.corners[corner].after;
  right.left_end = sweep_.corners[corner].before;
  open_slab(left);
  open_slab(right);
}

void MonotoneTriangulation::merge(CornerId corner) {
  const SlabId left = right_of_[corner];
  const SlabId right = left_of_[corner];
  Slab both;
  both.left_piece = meet_right(slabs_[left], corner);
  both.right_piece = meet_left(slabs_[right], corner);
  both.left_end = slabs_[left].left_end;
  both.right_end = slabs_[right].right_end;
  close_slab(left);
  close_slab(right);
  open_slab(both);
}

void MonotoneTriangulation::end(CornerId corner) {
  const Slab slab = slabs_[left_of_[corner]];
  close_slab(left_of_[corner]);
  close_piece(slab.left_piece, corner);
  if (slab.left_piece != slab.right_piece) close_piece(slab.right_piece, corner);
}

/// Triangulates a piece: visits both chains in one row upwards. A stack holds the corners that
/// still wait for a triangle, a chain that bends towards the other one.
void MonotoneTriangulation::triangulate(const Piece& piece) {
  const auto& left = piece.left;
  const auto& right = piece.right;
  row_.clear();
  row_.push_back({left.front(), true});
  for (std::size_t l = 1, r = 1; l + 1 < left.size() || r + 1 < right.size();) {
    const bool take_left = r + 1 == right.size() || (l + 1 < left.size() && left[l] < right[r]);
    row_.push_back({take_left ? left[l++] : right[r++], take_left});
  }
  row_.push_back({left.back(), true});

  stack_.assign(row_.begin(), row_.begin() + 2);
  for (std::size_t i = 2; i < row_.size(); ++i) {
    const Stacked now = row_[i];
    if (now.left != stack_.back().left || i + 1 == row_.size()) {
      for (std::size_t s = 1; s < stack_.size(); ++s)
        add_triangle(stack_[s - 1].corner, stack_[s].corner, now.corner);
      stack_.assign({stack_.back(), now});
      continue;
    }
    Stacked last = stack_.back();
    stack_.pop_back();
    while (!stack_.empty()) {
      const std::int32_t bend = turn(at(stack_.back().corner), at(last.corner), at(now.corner));
      if (now.left ? bend >= 0 : bend <= 0) break;
      add_triangle(stack_.back().corner, last.corner, now.corner);
      last = stack_.back();
      stack_.pop_back();
    }
    stack_.push_back(last);
    stack_.push_back(now);
  }
}

void MonotoneTriangulation::add_triangle(CornerId a, CornerId b, CornerId c) {
  if (turn(at(a), at(b), at(c)) < 0) std::swap(b, c);
  triangles_.push_back({sweep_.corners[a].point, sweep_.corners[b].point, sweep_.corners[c].point});
}

}  // namespace runstone::reference
