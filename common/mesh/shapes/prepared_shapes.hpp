// PreparedShapes: the faces of the shapes of one chunk in the form that the walk over its runs
// reads, and which of them a neighbour hides. Internal to the mesher of shapes.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/shapes/face_lists.hpp"
#include "common/runs/axis_order.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone::shape_mesh {

struct PreparedFace {
  std::uint64_t bits = 0;       // direction and face of a quad
  std::uint8_t list = 0;        // list_of()
  std::uint8_t size_shift = 0;  // of the size along the fastest axis, if the face joins along it
  bool joins_fast = false;      // along the fastest axis
  std::uint16_t number = 0;     // in ShapeFaces::faces()
};

/// The faces of a shape: those inside of the voxel, then those on its borders, side by side, which
/// neighbours can hide.
struct PreparedShape {
  std::uint16_t number = 0;                             // of the shape, from 1
  std::uint16_t inner = 0;                              // faces inside
  std::array<std::uint16_t, kDirectionCount> border{};  // faces on each side
  std::uint32_t first = 0, count = 0;                   // of all faces
  std::uint32_t most_in_list = 0;                       // the most faces that one list gets
};

/// The sides of a voxel by the rank of their axis, the negative one first.
using Sides = std::array<Direction, kDirectionCount>;
Sides sides_of(AxisOrder order);

/// The faces on a border are read in groups of this many, one bit each.
inline constexpr std::uint32_t kGroupFaces = 64;

class PreparedShapes {
 public:
  /// Begins a chunk. Requires that `shapes` outlives the use. What was prepared for the chunk
  /// before stays if it had the same shapes and axis order, within a bound of memory. Cost: O(1),
  /// or O(shapes).
  void begin(const ShapeTable& shapes, AxisOrder order);

  /// Returns the shape of this number. It and the faces are valid until the next call.
  /// Cost: O(1); at the first call O(faces).
  const PreparedShape& prepare(std::uint16_t number) {
    const std::uint16_t index = index_[number];
    return index != 0 ? prepared_[index - 1U] : append(number);
  }
  const PreparedFace* faces(std::uint32_t first) const { return faces_.data() + first; }
  /// Returns the faces of a group that the side of a neighbour's shape fills: bit i stands for face
  /// `first` + i. Requires faces on the border in direction d of the shape `own`, at most
  /// kGroupFaces. Cost: O(1); O(faces) for a pair that was not among the last ones.
  std::uint64_t covered(std::uint16_t own, std::uint16_t other, Direction d, std::uint32_t first,
                        std::uint32_t end) {
    // Faces have numbers below 2^10 within a shape, and `first` ascends with them, so that the
    // first face of a group names the group.
    const std::uint64_t key = std::uint64_t{first} << 32 | std::uint64_t{own} << 16 | other;
    Memo& memo = memos_[(key * 0x9e37'79b9'7f4a'7c15) >> (64 - kMemoBits)];
    if (memo.key != key) memo = {key, cover(own, other, d, first, end)};
    return memo.covered;
  }

 private:
  static constexpr unsigned kMemoBits = 10;
  struct Memo {
    std::uint64_t key = 0;  // 0: none, because numbers of shapes are above 0
    std::uint64_t covered = 0;
  };
  const PreparedShape& append(std::uint16_t number);
  std::uint64_t cover(std::uint16_t own, std::uint16_t other, Direction d, std::uint32_t first,
                      std::uint32_t end);

  /// The cells of a side: bit u of row v.
  using SideRows = std::array<std::uint16_t, kShapeUnits>;
  struct OtherShape {
    std::array<SideRows, kDirectionCount> sides;  // by direction
  };
  const OtherShape& rows_of(std::uint16_t number);

  /// With more faces, or more shapes beside them, a chunk begins anew.
  static constexpr std::size_t kKeptFacesMax = 16'384, kKeptOthersMax = 1'024;

  const ShapeTable* shapes_ = nullptr;
  std::uint64_t serial_ = 0;  // of the shapes
  AxisOrder order_{};
  Sides sides_{};
  std::vector<std::uint16_t> index_;  // by number of the shape: in prepared_, plus 1
  std::vector<PreparedShape> prepared_;
  std::vector<std::uint16_t> other_index_;  // by number of the shape: in others_, plus 1
  std::vector<OtherShape> others_;
  std::vector<PreparedFace> faces_;
  std::array<Memo, std::size_t{1} << kMemoBits> memos_;
};

}  // namespace runstone::shape_mesh
