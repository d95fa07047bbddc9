// TransparentTree: gives, for every place of the eye, the order in which the transparent quads of a
// chunk are blended correctly: what lies behind comes first, also between faces of different
// directions, and between faces of cubes and of shapes. It is a binary space partition (Fuchs,
// Kedem and Naylor 1980) whose planes are those of the quads. A quad that crosses a plane is cut
// into two, so no quads hide each other in a circle. There are two exceptions, both within one
// voxel:
//   - A quad cannot be cut inside of a voxel. If each plane of some quads lies inside of a voxel
//     and crosses another of them there, one piece is ordered by its middle.
//   - The planes of a plant cross each other, and have no order among themselves.
// Pure.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "client/render/quad_spans.hpp"
#include "common/mesh/quad.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {

class TransparentTree {
 public:
  /// A chunk with more quads, or with more pieces of them, has no tree.
  static constexpr std::size_t kQuadsMax = 1024, kPiecesMax = 2048;

  /// Makes the tree of a chunk's quads. `shapes` has the faces to which the quads refer; a quad
  /// whose face it does not have counts as a side of whole voxels. Returns nullopt if the quads are
  /// too many. Cost: O(pieces x depth of the tree).
  static std::optional<TransparentTree> build(std::span<const Quad> quads,
                                              const ShapeTable& shapes);

  /// Returns the pieces in the order to which the spans refer.
  std::span<const Quad> pieces() const { return pieces_; }
  /// Appends the spans of all pieces from back to front; piece 0 lies at `first` in the buffer.
  /// `eye` is in voxels relative to the origin of the chunk. Cost: O(planes).
  void append_back_to_front(const std::array<double, 3>& eye, std::uint32_t first,
                            std::vector<QuadSpan>& out) const;

 private:
  static constexpr std::int32_t kNone = -1;
  /// A plane, the pieces in it, and the nodes on its two sides.
  struct Node {
    std::size_t axis = 0;
    std::int32_t at = 0;  // along the axis, in sixteenths of a voxel
    std::uint32_t first = 0, count = 0;
    std::int32_t below = kNone, above = kNone;
  };
  struct Building;
  /// Returns the node of the quads, or kNone if there are none or too many pieces.
  std::int32_t add(std::vector<QuadFields> quads, Building& building);
  void append(std::int32_t node, const std::array<double, 3>& eye, std::uint32_t first,
              std::vector<QuadSpan>& out) const;

  std::vector<Node> nodes_;
  std::vector<Quad> pieces_;
  std::int32_t root_ = kNone;
};

}  // namespace runstone
