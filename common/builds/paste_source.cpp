#include "common/builds/paste_source.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/core/assert.hpp"
#include "common/edits/clipboard/clipboard.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

std::uint64_t cells_in_box(const VoxelBox& box) {
  return static_cast<std::uint64_t>(box.max.x - box.min.x) *
         static_cast<std::uint64_t>(box.max.y - box.min.y) *
         static_cast<std::uint64_t>(box.max.z - box.min.z);
}

std::uint64_t chunks_of(const VoxelBox& box, std::int32_t edge) {
  const ChunkCoord first = chunk_of(box.min, edge);
  const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
  return static_cast<std::uint64_t>(last.x - first.x + 1) *
         static_cast<std::uint64_t>(last.y - first.y + 1) *
         static_cast<std::uint64_t>(last.z - first.z + 1);
}

VoxelBox relative_to(const VoxelBox& box, VoxelPos origin) {
  return {{box.min.x - origin.x, box.min.y - origin.y, box.min.z - origin.z},
          {box.max.x - origin.x, box.max.y - origin.y, box.max.z - origin.z}};
}

bool fits_sides(const VoxelBox& box) {
  const auto side_max = static_cast<std::int32_t>(kSideMax);
  return box.max.x - box.min.x <= side_max && box.max.y - box.min.y <= side_max &&
         box.max.z - box.min.z <= side_max;
}

/// Cells with the numbers of a clipboard: 0 is untouched, and n is entry n - 1 of the palette.
struct NumberedCells {
  std::vector<Material> palette;  // ascending, each used
  RunChunk cells;
};

/// Returns cells of a build with the numbers of a clipboard. The number `skipped` becomes untouched.
/// Cost: O(runs + numbers of the build).
NumberedCells numbered_cells(const Build& build, const RunChunk& cells, std::uint16_t skipped) {
  std::vector<std::uint16_t> numbers;  // by cell number of the build
  std::vector<std::uint16_t> used;
  cells.runs.visit([&](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::uint16_t number = runs.material(i);
      if (number >= numbers.size()) numbers.resize(std::size_t{number} + 1);
      if (number == 0 || number == skipped || numbers[number] != 0) continue;
      numbers[number] = 1;
      used.push_back(number);
    }
  });
  std::sort(used.begin(), used.end(), [&](std::uint16_t a, std::uint16_t b) {
    return build.material(a) < build.material(b);
  });
  NumberedCells out;
  for (const std::uint16_t number : used) {
    const Material material = build.material(number);
    if (out.palette.empty() || out.palette.back() != material) out.palette.push_back(material);
    numbers[number] = static_cast<std::uint16_t>(out.palette.size());
  }
  RunBuilder builder(cells.extent, cells.order);
  cells.runs.visit([&](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i)
      builder.append_to(runs.end(i), numbers[runs.material(i)]);
  });
  out.cells = builder.finish();
  return out;
}

/// Returns the clipboard of some cells, or nullptr if no cell is touched or it is too long.
std::shared_ptr<const Clipboard> clipboard_of(const Build& build, const RunChunk& cells,
                                              std::uint16_t skipped, const PasteLimits& limits) {
  NumberedCells numbered = numbered_cells(build, cells, skipped);
  if (numbered.palette.empty()) return nullptr;
  const auto counts = runs_per_order(numbered.cells);
  const auto fewest = std::min_element(counts.begin(), counts.end());
  // A run takes a byte at least. So cells that are too many are known before they are put into
  // another order, which is dear: a part of scattered cells is cut several times.
  if (*fewest + numbered.palette.size() > std::min(limits.clipboard_bytes_max, kClipboardBytesMax))
    return nullptr;
  const AxisOrder order = kAxisOrders[static_cast<std::size_t>(fewest - counts.begin())];
  auto made = Clipboard::of(std::move(numbered.palette), reorder(numbered.cells, order));
  if (!made || (*made)->byte_size() > limits.clipboard_bytes_max) return nullptr;
  return *std::move(made);
}

std::uint64_t touched_cells(const RunChunk& cells, std::uint16_t skipped) {
  std::uint64_t out = 0;
  cells.runs.visit([&](const auto& runs) {
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < runs.size(); begin = runs.end(i++)) {
      const std::uint16_t number = runs.material(i);
      if (number != 0 && number != skipped) out += runs.end(i) - begin;
    }
  });
  return out;
}

std::uint16_t skipped_number(const Build& build, EmptyCells empty) {
  return empty == EmptyCells::skipped ? build.number_of(kEmpty).value_or(0) : std::uint16_t{0};
}

/// Returns the plane along an axis at which a part is cut: the border of chunks that is nearest to
/// its middle, or the middle inside a chunk. Requires a side of at least 2.
std::int32_t plane_of_split(std::int32_t low, std::int32_t high, std::int32_t edge) {
  const std::int32_t middle = low + (high - low) / 2;
  const std::int32_t below = floor_div(middle, edge) * edge;
  const bool has_below = below > low, has_above = below + edge < high;
  if (has_below && (!has_above || middle - below <= below + edge - middle)) return below;
  return has_above ? below + edge : middle;
}

}  // namespace

PasteSource::PasteSource(BuildPtr build, VoxelPos at, Mask mask, EmptyCells empty,
                         const PasteLimits& limits)
    : build_(std::move(build)), mask_(mask), limits_(limits) {
  RUNSTONE_ASSERT(build_ && limits.chunk_edge > 0 && limits.volume_max > 0);
  const VoxelPos sides = build_->sides();
  box_ = {at, {at.x + sides.x, at.y + sides.y, at.z + sides.z}};
  skipped_ = skipped_number(*build_, empty);
  block_edge_ = std::max(kPasteBlockEdge, limits.chunk_edge);
  restart();
}

void PasteSource::restart() {
  block_.reset();
  parts_.clear();
  cells_done_ = 0;
  // A build that fits one descriptor is not cut. Its box is the only part, and there are no blocks.
  if (fits_sides(box_)) {
    parts_.push_back(box_);
    block_ = chunk_of({box_.max.x - 1, box_.max.y - 1, box_.max.z - 1}, block_edge_);
  }
}

bool PasteSource::next_block() {
  const ChunkCoord first = chunk_of(box_.min, block_edge_);
  const ChunkCoord last = chunk_of({box_.max.x - 1, box_.max.y - 1, box_.max.z - 1}, block_edge_);
  if (!block_) {
    block_ = first;
  } else if (*block_ == last) {
    return false;
  } else if (block_->x != last.x) {
    ++block_->x;
  } else if (block_->z != last.z) {
    block_ = {first.x, block_->y, block_->z + 1};
  } else {
    block_ = {first.x, block_->y + 1, first.z};
  }
  parts_.push_back(intersect(box_, runstone::box_of(*block_, block_edge_)));
  return true;
}

std::optional<EditDescriptor> PasteSource::next() {
  for (;;) {
    if (parts_.empty() && !next_block()) return std::nullopt;
    const VoxelBox part = parts_.back();
    parts_.pop_back();
    cells_done_ += cells_in_box(part);
    if (auto edit = edit_of(part)) return edit;
  }
}

void PasteSource::split(const VoxelBox& part) {
  const std::int32_t x = part.max.x - part.min.x, y = part.max.y - part.min.y,
                     z = part.max.z - part.min.z;
  const std::int32_t longest = std::max({x, y, z});
  RUNSTONE_ASSERT(longest > 1);
  // The longest axis is cut first; among equal ones y, so that the lower half comes first.
  std::int32_t VoxelPos::* const along = y == longest   ? &VoxelPos::y
                                         : z == longest ? &VoxelPos::z
                                                        : &VoxelPos::x;
  VoxelBox low = part, high = part;
  low.max.*along = high.min.*along =
                       plane_of_split(part.min.*along, part.max.*along, limits_.chunk_edge);
  cells_done_ -= cells_in_box(part);
  parts_.push_back(high);
  parts_.push_back(low);
}

std::optional<EditDescriptor> PasteSource::edit_of(const VoxelBox& part) {
  const RunChunk cells = cells_in(*build_, relative_to(part, box_.min));
  const std::uint64_t touched = touched_cells(cells, skipped_);
  if (touched == 0) return std::nullopt;
  const std::uint64_t volume = cells_in_box(part);
  const bool fits =
      touched <= limits_.volume_max && chunks_of(part, limits_.chunk_edge) <= limits_.chunks_max;
  if (fits && touched == volume && cells.is_uniform())
    return EditDescriptor{FillBox{part}, mask_, build_->material(cells.runs.material(0))};
  if (fits) {
    if (auto clipboard = clipboard_of(*build_, cells, skipped_, limits_))
      return EditDescriptor{Paste{part.min, std::move(clipboard), {}}, mask_, kEmpty};
  }
  split(part);
  return std::nullopt;
}

std::shared_ptr<const Clipboard> whole_clipboard(const Build& build, EmptyCells empty,
                                                 const PasteLimits& limits) {
  if (!fits_sides(build.box())) return nullptr;
  const std::uint16_t skipped = skipped_number(build, empty);
  const RunChunk cells = cells_in(build, build.box());
  const std::uint64_t touched = touched_cells(cells, skipped);
  if (touched == 0 || touched > limits.volume_max) return nullptr;
  // Wherever the build is pasted, each of its sides meets one chunk more at most.
  const VoxelPos s = build.sides();
  const auto along = [&](std::int32_t side) {
    return static_cast<std::uint64_t>((side + limits.chunk_edge - 2) / limits.chunk_edge + 1);
  };
  if (along(s.x) * along(s.y) * along(s.z) > limits.chunks_max) return nullptr;
  return clipboard_of(build, cells, skipped, limits);
}

BuildPtr build_of(const Clipboard& clipboard) {
  const auto sides = clipboard.extent().sides();
  auto out = BuildBuilder::of({std::vector<std::int32_t>{0, sides[0]},
                               std::vector<std::int32_t>{0, sides[1]},
                               std::vector<std::int32_t>{0, sides[2]}});
  RUNSTONE_ASSERT(out.has_value());
  for (const Material material : clipboard.palette()) static_cast<void>(out->number_of(material));
  const auto put = out->put({}, clipboard.cells());
  RUNSTONE_ASSERT(put.has_value());
  auto made = out->finish();
  RUNSTONE_ASSERT(made.has_value());
  return *std::move(made);
}

}  // namespace runstone
