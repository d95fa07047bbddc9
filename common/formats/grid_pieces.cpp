#include "common/formats/grid_pieces.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/build_info.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

constexpr std::uint32_t kGridEdge = 64;
// Large layers have larger pieces, because the pieces of a slab are in memory at a time.
constexpr std::uint32_t kLargeGridEdge = 128;

std::array<std::int32_t, 3> by_axis(VoxelPos at) { return {at.x, at.y, at.z}; }

std::size_t axis_of(AxisOrder order, std::size_t i) {
  return static_cast<std::size_t>(axes_of(order)[i]);
}

}  // namespace

GridPieces::Span GridPieces::Side::span(std::uint32_t piece) const {
  const std::uint32_t begin = piece * edge;
  return {begin > offset ? begin - offset : 0, std::min(begin + edge - offset, cells)};
}

GridPieces::GridPieces(const VoxelBox& box, AxisOrder order,
                       const std::vector<ForeignBlock>& blocks, const PieceSink& sink)
    : order_(order), blocks_(blocks), sink_(sink) {
  RUNSTONE_ASSERT(!box.empty());
  const auto side = [&](std::size_t i) {
    Side out;
    out.axis = axis_of(order, i);
    out.low = by_axis(box.min)[out.axis];
    out.cells = static_cast<std::uint32_t>(by_axis(box.max)[out.axis] - out.low);
    return out;
  };
  fast_ = side(0);
  middle_ = side(1);
  slow_ = side(2);
  const std::uint64_t layer = std::uint64_t{fast_.cells} * middle_.cells;
  RUNSTONE_ASSERT(layer <= kGridVolumeMax);
  fast_.edge = middle_.edge = layer <= kGridLayerMax ? kGridEdge : kLargeGridEdge;
  slow_.edge = kGridEdge;
  for (Side* each : {&fast_, &middle_, &slow_})
    each->offset = static_cast<std::uint32_t>(each->low) & (each->edge - 1);
  wide_ = fast_.pieces();
  left_ = layer * slow_.cells;
  begin_slab();
}

bool GridPieces::are_sides(VoxelPos sides, AxisOrder order) {
  const auto all = by_axis(sides);
  const bool are_valid = std::all_of(
      all.begin(), all.end(), [](std::int32_t side) { return side >= 1 && side <= kBuildSideMax; });
  return are_valid && static_cast<std::uint64_t>(all[axis_of(order, 0)]) *
                              static_cast<std::uint64_t>(all[axis_of(order, 1)]) <=
                          kGridLayerMax;
}

void GridPieces::begin_slab() {
  slab_ = slow_.span(slow_.piece_at(slab_.end));
  pieces_.clear();
  std::array<std::uint8_t, 3> extent{};
  extent[slow_.axis] = static_cast<std::uint8_t>(slab_.size());
  for (std::uint32_t m = 0; m < middle_.pieces(); ++m) {
    extent[middle_.axis] = static_cast<std::uint8_t>(middle_.span(m).size());
    for (std::uint32_t f = 0; f < fast_.pieces(); ++f) {
      extent[fast_.axis] = static_cast<std::uint8_t>(fast_.span(f).size());
      pieces_.emplace_back(Extent{extent[0], extent[1], extent[2]}, order_);
    }
  }
  layer_ = row_ = piece_ = 0;
  span_left_ = span_rows_ = 0;
}

/// Goes to the next span, or to the end of the slab.
void GridPieces::advance() {
  if (span_rows_ != 0 && ++piece_ == wide_) {  // 0: the first span of the slab
    piece_ = 0;
    row_ += span_rows_;
    if (row_ == middle_.cells) {
      row_ = 0;
      layer_ += span_layers_;
    }
  }
  const std::uint32_t middle_piece = middle_.piece_at(row_);
  open_ = std::size_t{middle_piece} * wide_ + piece_;
  span_rows_ = wide_ == 1 ? middle_.span(middle_piece).size() : 1;
  span_layers_ = wide_ == 1 && middle_.pieces() == 1 ? slab_.size() : 1;
  span_left_ = fast_.span(piece_).size() * span_rows_ * span_layers_;
}

Result<void> GridPieces::append(std::uint64_t count, Material material) {
  RUNSTONE_DASSERT(count <= left_ && material <= blocks_.size());
  while (count > 0) {
    if (span_left_ == 0) advance();
    const auto part = static_cast<std::uint32_t>(std::min<std::uint64_t>(count, span_left_));
    pieces_[open_].append(part, material);
    count -= part;
    span_left_ -= part;
    left_ -= part;
    const bool is_last = span_left_ == 0 && piece_ + 1 == wide_ &&
                         row_ + span_rows_ == middle_.cells &&
                         layer_ + span_layers_ == slab_.size();
    if (!is_last) continue;
    if (auto given = give_slab(); !given) return given;
    if (left_ > 0) begin_slab();
  }
  return {};
}

Result<void> GridPieces::give_slab() {
  std::array<std::int32_t, 3> origin{};
  const auto set = [&](const Side& side, std::uint32_t cell) {
    origin[side.axis] = side.low + static_cast<std::int32_t>(cell);
  };
  set(slow_, slab_.begin);
  std::size_t piece = 0;
  for (std::uint32_t m = 0; m < middle_.pieces(); ++m) {
    set(middle_, middle_.span(m).begin);
    for (std::uint32_t f = 0; f < fast_.pieces(); ++f) {
      set(fast_, fast_.span(f).begin);
      if (auto taken =
              sink_(piece_of(pieces_[piece++].finish(), {origin[0], origin[1], origin[2]}));
          !taken)
        return taken;
    }
  }
  return {};
}

/// Numbers the blocks that occur in the piece. The palette of a whole file may be long.
ForeignPiece GridPieces::piece_of(RunChunk cells, VoxelPos origin) {
  numbers_.resize(blocks_.size() + 1);
  std::vector<Material> used;
  ForeignPiece piece;
  piece.origin = origin;
  RunBuilder out(cells.extent, cells.order);
  cells.runs.visit([&](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const Material material = runs.material(i);
      if (material != 0 && numbers_[material] == 0) {
        used.push_back(material);
        numbers_[material] = static_cast<Material>(used.size());
        piece.blocks.push_back(blocks_[material - 1u]);
      }
      out.append_to(runs.end(i), numbers_[material]);
    }
  });
  for (const Material material : used) numbers_[material] = 0;
  piece.voxels = in_cheapest_order(out.finish());
  return piece;
}

}  // namespace runstone
