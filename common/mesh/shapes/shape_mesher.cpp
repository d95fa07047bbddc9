#include "common/mesh/shapes/shape_mesher.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include "common/mesh/shapes/beyond_border.hpp"
#include "common/mesh/shapes/face_lists.hpp"
#include "common/mesh/shapes/prepared_shapes.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone {

struct ShapeScratch::State {
  std::array<shape_mesh::PreparedShapes, kAxisOrderCount> by_order;
  shape_mesh::BeyondBorder beyond;
  shape_mesh::FaceLists lists;
};

ShapeScratch::ShapeScratch() : state_(std::make_unique<State>()) {}
ShapeScratch::~ShapeScratch() = default;
ShapeScratch::ShapeScratch(ShapeScratch&&) noexcept = default;
ShapeScratch& ShapeScratch::operator=(ShapeScratch&&) noexcept = default;

namespace shape_mesh {
namespace {

/// The part of a run of a shape that lies in one line.
struct Piece {
  std::size_t run;
  std::uint32_t first, length;  // voxels of the flattened chunk
  std::uint32_t f;              // of the first one, along the fastest axis
  unsigned borders;             // bit per side across the other axes: it is that of the chunk
  std::uint64_t place;          // its coordinates in the bits of a quad
  Material material;
};

/// The walk over the runs of one chunk. A cursor for each neighbouring line, before and behind
/// along the middle and the slowest axis, moves on in step.
template <class Runs>
class ShapeWalk {
 public:
  ShapeWalk(Runs runs, const RunChunk& chunk, const VisibilityTable& visibility,
            const ShapeTable& shapes, ShapeScratch::State& state)
      : runs_(runs),
        e_(ordered(chunk.extent, chunk.order)),
        visibility_(visibility.data()),
        shapes_(shapes),
        state_(state),
        prepared_(state.by_order[static_cast<std::size_t>(chunk.order)]),
        cursors_{RunCursor<Runs>(runs), RunCursor<Runs>(runs), RunCursor<Runs>(runs),
                 RunCursor<Runs>(runs)},
        directions_(sides_of(chunk.order)) {
    const auto axes = axes_of(chunk.order);
    for (std::size_t rank = 0; rank < 3; ++rank) shift_[rank] = place_shift(axes[rank]);
    steps_ = {0, 0, 0 - e_.f, e_.f, 0 - e_.layer(), e_.layer()};
  }

  /// Adds the faces of all shapes from run `first` on. Returns false if the chunk has
  /// kShapeQuadsMax and more follow.
  bool walk(std::size_t first) {
    std::uint32_t begin = first == 0 ? 0 : runs_.end(first - 1);
    for (std::size_t run = first; run < runs_.size(); ++run) {
      const std::uint32_t end = runs_.end(run);
      const Material material = runs_.material(run);
      const std::uint16_t number = shapes_.number(material);
      if (number != 0 && visibility_[material] != Visibility::empty) {
        lists_ = &state_.lists.pass(visibility_[material] == Visibility::transparent);
        if (!add_run(run, begin, end, material, prepared_.prepare(number))) return false;
      }
      begin = end;
    }
    return true;
  }

 private:
  /// Adds the faces of one run. Returns false if the chunk has kShapeQuadsMax.
  bool add_run(std::size_t run, std::uint32_t begin, std::uint32_t end, Material material,
               const PreparedShape& shape) {
    std::uint32_t line = begin / e_.f;
    std::uint32_t f = begin - line * e_.f, s = line / e_.m, m = line - s * e_.m;
    for (std::uint32_t at = begin; at < end;) {
      const std::uint32_t length = std::min(end - at, e_.f - f);
      if (!state_.lists.make_room(std::size_t{length} * shape.most_in_list,
                                  std::size_t{length} * shape.count))
        return false;
      const std::uint64_t place = std::uint64_t{f} << shift_[0] | std::uint64_t{m} << shift_[1] |
                                  std::uint64_t{s} << shift_[2];
      const unsigned borders = (m == 0 ? 4U : 0U) | (m + 1 == e_.m ? 8U : 0U) |
                               (s == 0 ? 16U : 0U) | (s + 1 == e_.s ? 32U : 0U);
      add_piece({run, at, length, f, borders, place, material}, shape);
      at += length;
      f = 0;
      if (++m == e_.m) {
        m = 0;
        ++s;
      }
    }
    return true;
  }

  void add_piece(const Piece& piece, const PreparedShape& shape) {
    if (piece.length == 1) return add_voxel(piece, shape);
    std::uint32_t at = shape.first;
    for (const std::uint32_t end = at + shape.inner; at < end; ++at)
      add(piece, *prepared_.faces(at), 0, piece.length);
    for (std::size_t side = 0; side < shape.border.size(); ++side) {
      for (const std::uint32_t border_end = at + shape.border[side]; at < border_end;) {
        const std::uint32_t end = std::min(border_end, at + kGroupFaces);
        if (side < 2) {
          add_along(piece, shape, side, at, end);
        } else {
          add_beside(piece, shape, side, at, end);
        }
        at = end;
      }
    }
  }

  /// Adds the faces of a single voxel.
  void add_voxel(const Piece& piece, const PreparedShape& shape) {
    const std::uint64_t base = std::uint64_t{piece.material} << 38 | piece.place;
    Quad** const ends = lists_->end.data();
    const PreparedFace* face = prepared_.faces(shape.first);
    for (const PreparedFace* const end = face + shape.inner; face < end; ++face)
      *ends[face->list]++ = {base | face->bits};
    [&]<std::size_t... kSides>(std::index_sequence<kSides...>) {
      (add_side<kSides>(piece, shape, base, ends, face), ...);
    }(std::make_index_sequence<kDirectionCount>{});
  }

  /// Adds the faces on one side of a single voxel, from `face` on. Moves `face` behind them.
  template <std::size_t kSide>
  void add_side(const Piece& piece, const PreparedShape& shape, std::uint64_t base,
                Quad** const ends, const PreparedFace*& face) {
    const PreparedFace* const end = face + shape.border[kSide];
    if (face == end) return;
    const Material other = material_beside(piece, kSide);
    if (other != kEmpty) {
      const std::uint16_t number = shapes_.number(other);
      const bool is_opaque = visibility_[other] == Visibility::opaque;
      if (number == 0 ? is_opaque : is_opaque || other == piece.material) {
        if (number != 0) add_uncovered(base, shape, number, kSide, face, end);
        face = end;
        return;
      }
    }
    do {
      *ends[face->list]++ = {base | face->bits};
    } while (++face < end);
  }

  /// Adds the faces on the border of a single voxel that a shape beside it does not fill.
  void add_uncovered(std::uint64_t base, const PreparedShape& shape, std::uint16_t number,
                     std::size_t side, const PreparedFace* face, const PreparedFace* end) {
    while (face < end) {
      const auto first = static_cast<std::uint32_t>(face - prepared_.faces(0));
      const auto count = std::min(static_cast<std::uint32_t>(end - face), kGroupFaces);
      const std::uint64_t covered =
          prepared_.covered(shape.number, number, directions_[side], first, first + count);
      for_each_bit(bits_of(count) & ~covered,
                   [&](unsigned i) { *lists_->end[face[i].list]++ = {base | face[i].bits}; });
      face += count;
    }
  }

  /// Returns the material beside a piece of a single voxel, or of the first or last voxel of a
  /// longer one along the fastest axis.
  Material material_beside(const Piece& piece, std::size_t side) {
    const Direction d = directions_[side];
    switch (side) {
      case 0:
        return piece.f == 0 ? state_.beyond.at(d, piece.place) : runs_.material(piece.run - 1);
      case 1:
        return piece.f + piece.length == e_.f
                   ? state_.beyond.at(d, piece.place + place_step(piece.length - 1))
                   : runs_.material(piece.run + 1);
      default:
        if (is_at_border(piece, side)) return state_.beyond.at(d, piece.place);
        return cursor_at(side, beside(piece, side)).material();
    }
  }

  /// Requires a side across the middle or the slowest axis, as beside() does.
  bool is_at_border(const Piece& piece, std::size_t side) const {
    return (piece.borders >> side & 1) != 0;
  }
  /// Returns the voxel beside the first one of a piece.
  std::uint32_t beside(const Piece& piece, std::size_t side) const {
    return piece.first + steps_[side];
  }
  const RunCursor<Runs>& cursor_at(std::size_t side, std::uint32_t voxel) {
    RunCursor<Runs>& cursor = cursors_[side - 2];
    // Often one of the next runs covers it, which the search of seek() would pass.
    for (unsigned i = 0; i < 4 && cursor.end() <= voxel; ++i) cursor.next();
    if (cursor.end() <= voxel) cursor.seek(voxel);
    return cursor;
  }

  /// Returns a bit for each face of a group that a voxel of this material before it hides.
  std::uint64_t hidden(const Piece& piece, const PreparedShape& shape, Material other, Direction d,
                       std::uint32_t first, std::uint32_t end) {
    if (other == kEmpty) return 0;
    const std::uint16_t number = shapes_.number(other);
    const bool is_opaque = visibility_[other] == Visibility::opaque;
    if (number == 0) return is_opaque ? ~std::uint64_t{0} : 0;
    if (!is_opaque && other != piece.material) return 0;
    return prepared_.covered(shape.number, number, d, first, end);
  }

  /// Adds the faces on the border along the fastest axis: the next voxel is one of the piece, but
  /// at its end.
  void add_along(const Piece& piece, const PreparedShape& shape, std::size_t side,
                 std::uint32_t first, std::uint32_t end) {
    const Direction d = directions_[side];
    const bool is_last = side == 1;
    const Material other = material_beside(piece, side);
    const std::uint64_t all = bits_of(end - first);
    const std::uint64_t at_end = all & ~hidden(piece, shape, other, d, first, end);
    const std::uint64_t within =
        piece.length == 1 ? 0 : all & ~hidden(piece, shape, piece.material, d, first, end);
    const std::uint32_t end_at = is_last ? piece.length - 1 : 0;
    for_each_bit(at_end | within, [&](unsigned i) {
      const bool shows_end = (at_end >> i & 1) != 0, shows_within = (within >> i & 1) != 0;
      const std::uint32_t from = shows_within ? (!shows_end && end_at == 0 ? 1 : 0) : end_at;
      const std::uint32_t to =
          shows_within ? piece.length - (!shows_end && end_at != 0 ? 1 : 0) : end_at + 1;
      add(piece, *prepared_.faces(first + i), from, to);
    });
  }

  /// Adds the faces on the border along the middle and the slowest axis.
  void add_beside(const Piece& piece, const PreparedShape& shape, std::size_t side,
                  std::uint32_t first, std::uint32_t end) {
    Strips strips(*this, piece, first, bits_of(end - first));
    const Direction d = directions_[side];
    if (is_at_border(piece, side)) {
      Material before = kEmpty;
      for (std::uint32_t i = 0; i < piece.length; ++i) {
        const Material other = state_.beyond.at(d, piece.place + place_step(i));
        if (i == 0 || other != before) strips.turn(i, hidden(piece, shape, other, d, first, end));
        before = other;
      }
    } else {
      const std::uint32_t begin = beside(piece, side);
      // A copy, because the next group of faces begins here again.
      RunCursor<Runs> cursor = cursor_at(side, begin);
      for (std::uint32_t i = 0;;) {
        strips.turn(i, hidden(piece, shape, cursor.material(), d, first, end));
        i = cursor.end() - begin;
        if (i >= piece.length) break;
        cursor.next();
      }
    }
    strips.turn(piece.length, ~std::uint64_t{0});
  }

  /// The faces of one group that are visible at present, and where each became so.
  struct Strips {
    Strips(ShapeWalk& of, const Piece& of_piece, std::uint32_t first_face, std::uint64_t all_faces)
        : walk(of), piece(of_piece), first(first_face), all(all_faces) {}

    ShapeWalk& walk;
    const Piece& piece;
    std::uint32_t first;
    std::uint64_t all;
    std::uint64_t open = 0;
    std::array<std::uint8_t, kGroupFaces> since;  // of the open ones

    /// From place i of the piece on, the faces of these bits are hidden and the others are not.
    void turn(std::uint32_t i, std::uint64_t hidden) {
      const std::uint64_t now = all & ~hidden;
      for_each_bit(open & ~now, [&](unsigned face) {
        walk.add(piece, *walk.prepared_.faces(first + face), since[face], i);
      });
      for_each_bit(now & ~open, [&](unsigned face) { since[face] = static_cast<std::uint8_t>(i); });
      open = now;
    }
  };

  /// Adds a face of the voxels [from, to) of a piece.
  void add(const Piece& piece, const PreparedFace& face, std::uint32_t from, std::uint32_t to) {
    std::uint64_t bits =
        face.bits | std::uint64_t{piece.material} << 38 | (piece.place + place_step(from));
    Quad*& end = lists_->end[face.list];
    if (face.joins_fast) {
      *end++ = {bits | std::uint64_t{to - from - 1} << face.size_shift};
      return;
    }
    for (std::uint32_t i = from; i < to; ++i, bits += place_step(1)) *end++ = {bits};
  }

  std::uint64_t place_step(std::uint32_t voxels) const {
    return std::uint64_t{voxels} << shift_[0];
  }
  static std::uint64_t bits_of(std::uint32_t count) { return ~std::uint64_t{0} >> (64 - count); }
  template <class F>
  static void for_each_bit(std::uint64_t bits, F&& f) {
    for (; bits != 0; bits &= bits - 1) f(static_cast<unsigned>(std::countr_zero(bits)));
  }

  Runs runs_;
  const OrderedExtent e_;
  const Visibility* const visibility_;  // by material
  const ShapeTable& shapes_;
  ShapeScratch::State& state_;
  PreparedShapes& prepared_;
  FaceLists::Pass* lists_ = nullptr;
  std::array<unsigned, 3> shift_{};         // of coordinates, by rank of the axis
  std::array<std::uint32_t, 6> steps_{};    // to the voxel beside one, by side; the fastest axis: 0
  std::array<RunCursor<Runs>, 4> cursors_;  // of the sides from 2 on
  const Sides directions_;
};

/// Lists of more quads are freed, so that no scratch keeps the memory of a chunk of the worst case.
constexpr std::size_t kScratchQuadsMax = std::size_t{1} << 19;

template <class Runs>
std::size_t find_shape(Runs runs, const ShapeTable& shapes) {
  std::size_t run = 0;
  while (run < runs.size() && shapes.is_cube(runs.material(run))) ++run;
  return run;
}

}  // namespace
}  // namespace shape_mesh

bool mesh_shapes(const RunChunk& chunk, const MeshNeighbours& neighbours,
                 const VisibilityTable& visibility, const ShapeTable& shapes, ShapeScratch& scratch,
                 ShapeQuads& out) {
  out.clear();
  if (shapes.empty()) return true;
  bool is_complete = true;
  chunk.runs.visit([&]<class Runs>(Runs runs) {
    const std::size_t first = shape_mesh::find_shape(runs, shapes);
    if (first == runs.size()) return;
    ShapeScratch::State& state = scratch.state();
    state.by_order[static_cast<std::size_t>(chunk.order)].begin(shapes, chunk.order);
    state.beyond.begin(chunk, neighbours);
    state.lists.begin();
    is_complete = shape_mesh::ShapeWalk<Runs>(runs, chunk, visibility, shapes, state).walk(first);
    state.lists.finish(chunk.order, out);
    if (state.lists.capacity() > shape_mesh::kScratchQuadsMax) state.lists = {};
  });
  return is_complete;
}

}  // namespace runstone
