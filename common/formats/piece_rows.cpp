#include "common/formats/piece_rows.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr std::uint32_t kLayers = 64;
// Wide boxes have larger tiles, because the tiles of a slab are in memory at a time.
constexpr std::uint32_t kTileSmall = 64, kTileLarge = 128;
constexpr std::uint64_t kSmallTilesAreaMax = std::uint64_t{1} << 28;

std::uint32_t side(std::int32_t low, std::int32_t high) {
  return static_cast<std::uint32_t>(high - low);
}

std::uint32_t offset_in_grid(std::int32_t low, std::uint32_t edge) {
  return static_cast<std::uint32_t>(low) & (edge - 1);
}

/// Cells of a side from `begin` to `end`.
struct TileSpan {
  std::uint32_t begin, end;
  std::uint32_t size() const { return end - begin; }
};

/// Returns the part of a side in a tile. `offset` is that of the side in the grid.
TileSpan tile_span(std::uint32_t side, std::uint32_t offset, std::uint32_t tile,
                   std::uint32_t edge) {
  const std::uint32_t begin = tile * edge;
  return {begin > offset ? begin - offset : 0, std::min(begin + edge - offset, side)};
}

std::int32_t tile_corner(std::int32_t low, std::uint32_t cells) {
  return low + static_cast<std::int32_t>(cells);
}

std::uint8_t extent_side(std::uint32_t side) { return static_cast<std::uint8_t>(side); }

}  // namespace

PieceRows::PieceRows(const VoxelBox& box, const std::vector<ForeignBlock>& blocks,
                     const PieceSink& sink)
    : low_(box.min),
      width_(side(box.min.x, box.max.x)),
      height_(side(box.min.y, box.max.y)),
      length_(side(box.min.z, box.max.z)),
      tile_(std::uint64_t{width_} * length_ <= kSmallTilesAreaMax ? kTileSmall : kTileLarge),
      offset_x_(offset_in_grid(box.min.x, tile_)),
      offset_y_(offset_in_grid(box.min.y, kLayers)),
      offset_z_(offset_in_grid(box.min.z, tile_)),
      tiles_x_((offset_x_ + width_ + tile_ - 1) / tile_),
      tiles_z_((offset_z_ + length_ + tile_ - 1) / tile_),
      blocks_(blocks),
      sink_(sink),
      left_(std::uint64_t{width_} * height_ * length_) {
  RUNSTONE_ASSERT(!box.empty() && left_ <= kPieceRowsVolumeMax);
  begin_slab();
}

void PieceRows::begin_slab() {
  slab_layers_ = std::min(kLayers - ((offset_y_ + slab_y_) & (kLayers - 1)), height_ - slab_y_);
  tiles_.clear();
  tiles_.reserve(std::size_t{tiles_x_} * tiles_z_);
  for (std::uint32_t z = 0; z < tiles_z_; ++z) {
    const std::uint32_t length = tile_span(length_, offset_z_, z, tile_).size();
    for (std::uint32_t x = 0; x < tiles_x_; ++x) {
      const std::uint32_t width = tile_span(width_, offset_x_, x, tile_).size();
      tiles_.emplace_back(
          Extent{extent_side(width), extent_side(slab_layers_), extent_side(length)},
          AxisOrder::xzy);
    }
  }
  y_ = z_ = tile_x_ = 0;
  span_left_ = 0;
}

/// Goes to the next span, or to the end of the slab.
void PieceRows::advance() {
  if (span_rows_ != 0) {  // not the first span of the slab
    if (++tile_x_ == tiles_x_) {
      tile_x_ = 0;
      z_ += span_rows_;
      if (z_ == length_) {
        z_ = 0;
        y_ += span_layers_;
      }
    }
  }
  const TileSpan along_z = tile_span(length_, offset_z_, (z_ + offset_z_) / tile_, tile_);
  span_rows_ = tiles_x_ == 1 ? along_z.size() : 1;
  span_layers_ = tiles_x_ == 1 && tiles_z_ == 1 ? slab_layers_ : 1;
  span_left_ = tile_span(width_, offset_x_, tile_x_, tile_).size() * span_rows_ * span_layers_;
}

Result<void> PieceRows::append(std::uint64_t count, Material material) {
  RUNSTONE_DASSERT(count <= left_ && material <= blocks_.size());
  while (count > 0) {
    if (span_left_ == 0) advance();
    const auto part = static_cast<std::uint32_t>(std::min<std::uint64_t>(count, span_left_));
    tiles_[std::size_t{(z_ + offset_z_) / tile_} * tiles_x_ + tile_x_].append(part, material);
    count -= part;
    span_left_ -= part;
    left_ -= part;
    const bool is_last = span_left_ == 0 && tile_x_ + 1 == tiles_x_ && z_ + span_rows_ == length_ &&
                         y_ + span_layers_ == slab_layers_;
    if (!is_last) continue;
    if (const auto given = give_slab(); !given) return given;
    slab_y_ += slab_layers_;
    span_rows_ = 0;
    if (slab_y_ < height_) begin_slab();
  }
  return {};
}

Result<void> PieceRows::give_slab() {
  for (std::uint32_t z = 0; z < tiles_z_; ++z) {
    for (std::uint32_t x = 0; x < tiles_x_; ++x) {
      RunChunk cells = tiles_[std::size_t{z} * tiles_x_ + x].finish();
      const VoxelPos origin{tile_corner(low_.x, tile_span(width_, offset_x_, x, tile_).begin),
                            tile_corner(low_.y, slab_y_),
                            tile_corner(low_.z, tile_span(length_, offset_z_, z, tile_).begin)};
      if (const auto taken = sink_(piece_of(std::move(cells), origin)); !taken)
        return failure(taken.error());
    }
  }
  return {};
}

/// Numbers the blocks that occur in the piece. The palette of a whole file may be long.
ForeignPiece PieceRows::piece_of(RunChunk cells, VoxelPos origin) {
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
  piece.voxels = out.finish();
  return piece;
}

}  // namespace runstone
