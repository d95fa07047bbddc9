#include "common/formats/grid_pieces.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/build_info.hpp"
#include "common/formats/block_assembler.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

constexpr std::uint32_t kGridEdge = 64;

std::uint32_t grid_pieces_along(std::uint32_t side) { return (side + kGridEdge - 1) / kGridEdge; }

std::uint32_t grid_piece_side(std::uint32_t side, std::uint32_t piece) {
  return std::min(kGridEdge, side - piece * kGridEdge);
}

}  // namespace

Result<GridPieces> GridPieces::of(VoxelPos sides, VoxelPos origin, AxisOrder order,
                                  const std::vector<ForeignBlock>& blocks, const PieceSink& sink) {
  const std::array<std::int32_t, 3> by_axis = {sides.x, sides.y, sides.z};
  for (const std::int32_t side : by_axis) {
    if (side < 1 || side > static_cast<std::int32_t>(kBuildSideMax))
      return fail(ErrorCode::limit_exceeded, "a side is outside 1 .. 1048576");
  }
  GridPieces out(blocks, sink);
  out.order_ = order;
  out.origin_ = {origin.x, origin.y, origin.z};
  const auto axes = axes_of(order);
  for (std::size_t i = 0; i < 3; ++i)
    out.sides_[i] = static_cast<std::uint32_t>(by_axis[static_cast<std::size_t>(axes[i])]);
  if (std::uint64_t{out.sides_[0]} * out.sides_[1] > kGridLayerMax)
    return fail(ErrorCode::limit_exceeded, "a layer has more than 268435456 cells");
  out.left_ = std::uint64_t{out.sides_[0]} * out.sides_[1] * out.sides_[2];
  out.pieces_along_ = grid_pieces_along(out.sides_[0]);
  out.begin_slab();
  return out;
}

std::uint32_t GridPieces::line_left() const {
  if (left_ == 0) return 0;
  return std::min(kGridEdge - at_[0] % kGridEdge, sides_[0] - at_[0]);
}

void GridPieces::begin_slab() {
  const std::uint32_t slow = grid_piece_side(sides_[2], at_[2] / kGridEdge);
  const auto axes = axes_of(order_);
  runs_.clear();
  for (std::uint32_t m = 0; m < grid_pieces_along(sides_[1]); ++m) {
    for (std::uint32_t f = 0; f < pieces_along_; ++f) {
      std::array<std::uint8_t, 3> extent{};
      extent[static_cast<std::size_t>(axes[0])] =
          static_cast<std::uint8_t>(grid_piece_side(sides_[0], f));
      extent[static_cast<std::size_t>(axes[1])] =
          static_cast<std::uint8_t>(grid_piece_side(sides_[1], m));
      extent[static_cast<std::size_t>(axes[2])] = static_cast<std::uint8_t>(slow);
      runs_.emplace_back(Extent{extent[0], extent[1], extent[2]}, order_);
    }
  }
}

Result<void> GridPieces::finish_slab() {
  const auto axes = axes_of(order_);
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    std::array<std::int32_t, 3> at = origin_;
    const auto add = [&](std::size_t axis, std::size_t piece) {
      at[static_cast<std::size_t>(axes[axis])] += static_cast<std::int32_t>(piece * kGridEdge);
    };
    add(0, i % pieces_along_);
    add(1, i / pieces_along_);
    add(2, (at_[2] - 1) / kGridEdge);
    ForeignPiece piece{{at[0], at[1], at[2]}, runs_[i].finish(), {}};
    // The piece has the blocks that occur in it.
    std::vector<Material> used;
    piece.voxels.runs.visit([&](const auto& runs) {
      for (std::size_t run = 0; run < runs.size(); ++run) {
        if (runs.material(run) != 0) used.push_back(runs.material(run));
      }
    });
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<Material> to(used.empty() ? 1 : used.back() + std::size_t{1}, 0);
    for (std::size_t block = 0; block < used.size(); ++block) {
      to[used[block]] = static_cast<Material>(block + 1);
      RUNSTONE_ASSERT(used[block] <= blocks_->size());
      piece.blocks.push_back((*blocks_)[used[block] - 1U]);
    }
    piece.voxels = in_cheapest_order(with_materials(piece.voxels, to));
    if (auto taken = (*sink_)(std::move(piece)); !taken) return taken;
  }
  return {};
}

Result<void> GridPieces::append(std::uint64_t count, Material cell) {
  RUNSTONE_ASSERT(count <= left_);
  while (count > 0) {
    const auto part = static_cast<std::uint32_t>(std::min<std::uint64_t>(count, line_left()));
    const std::size_t piece =
        at_[0] / kGridEdge + std::size_t{pieces_along_} * (at_[1] / kGridEdge);
    runs_[piece].append(part, cell);
    count -= part;
    left_ -= part;
    at_[0] += part;
    if (at_[0] < sides_[0]) continue;
    at_[0] = 0;
    if (++at_[1] < sides_[1]) continue;
    at_[1] = 0;
    ++at_[2];
    if (at_[2] % kGridEdge != 0 && at_[2] < sides_[2]) continue;
    if (auto finished = finish_slab(); !finished) return finished;
    if (left_ > 0) begin_slab();
  }
  return {};
}

}  // namespace runstone
