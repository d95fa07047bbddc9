// FaceLists: the quads of shapes before they are joined across lines and layers, by draw pass,
// direction and the axes along which they join. Internal to the mesher of shapes.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/quad.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone::shape_mesh {

/// Returns the lowest bit of a quad's coordinate along an axis.
constexpr unsigned place_shift(Axis axis) { return 7 * static_cast<unsigned>(axis); }
/// Returns the lowest bit of a quad's size along an axis. Requires another axis than that of the
/// direction.
constexpr unsigned size_shift(Direction d, Axis axis) {
  return axis == u_axis_of(axis_of(d)) ? 21 : 28;
}

/// The two axes across the strips of a direction, along which strips are joined. Strips lie along
/// the fastest axis. Faces across the fastest axis are single voxels, and are joined along both.
struct JoinAxes {
  Axis first{}, second{};
  bool has_second = false;
};
constexpr JoinAxes join_axes(AxisOrder order, Direction d) {
  const auto axes = axes_of(order);
  if (axis_of(d) == axes[0]) return {axes[1], axes[2], true};
  return {axis_of(d) == axes[1] ? axes[2] : axes[1], Axis{}, false};
}

/// The axes of JoinAxes along which a face joins.
enum Joins : std::uint8_t { kJoinsNone = 0, kJoinsFirst = 1, kJoinsSecond = 2, kJoinsBoth = 3 };

/// The number of a face's list within its draw pass: by direction, then by Joins.
constexpr std::size_t list_of(Direction d, Joins joins) {
  return 4 * static_cast<std::size_t>(d) + joins;
}
inline constexpr std::size_t kListCount = 4 * kDirectionCount;

class FaceLists {
 public:
  /// The lists of one draw pass. A caller that has room writes to *end[list]++.
  struct Pass {
    std::array<std::vector<Quad>, kListCount> buffers;  // their sizes are capacities
    std::array<Quad*, kListCount> end{};
  };
  Pass& pass(bool is_transparent) { return passes_[is_transparent ? 1 : 0]; }

  /// Empties all lists.
  void begin();
  /// Makes room for `in_one` more quads in each list, of which all together get `in_all` at most.
  /// Returns false, and makes none, if the lists have kShapeQuadsMax quads. Cost: O(1) amortised.
  bool make_room(std::size_t in_one, std::size_t in_all) {
    if ((in_one > room_ || in_all > room_in_all_) && !grow(in_one, in_all)) return false;
    room_ -= in_one;
    room_in_all_ -= in_all;
    return true;
  }
  /// Joins the quads and replaces `out` by them, ascending by direction. Requires lists in the order
  /// of the walk: each list ascends by layer, line and place. Cost: O(quads).
  void finish(AxisOrder order, ShapeQuads& out);
  /// Returns the quads for which there is memory.
  std::size_t capacity() const;

 private:
  /// The quads between two looks at the number of all quads, at most.
  static constexpr std::size_t kRoomMax = 65'536;
  bool grow(std::size_t in_one, std::size_t in_all);
  /// Returns the number of quads that are left of those from `first` to `end`.
  std::size_t join(Quad* first, const Quad* end, Direction d, Axis along);

  std::array<Pass, 2> passes_;
  std::size_t room_ = 0;              // in each list
  std::size_t room_in_all_ = 0;       // quads until the next look at their number
  std::vector<std::uint32_t> table_;  // of join(): number of a quad + 1, by a hash of its place
};

}  // namespace runstone::shape_mesh
