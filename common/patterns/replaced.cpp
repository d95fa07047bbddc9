#include "common/patterns/replaced.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "common/builds/paste_source.hpp"
#include "common/core/assert.hpp"
#include "common/patterns/column_slice.hpp"

namespace runstone {
namespace {

// The borders of slices are borders of sections.
static_assert(kColumnSliceEdge % kPasteBlockEdge == 0 &&
              std::int64_t{kColumnSliceEdge + 2} * (kColumnSliceEdge + 2) <= kGroundColumnsMax);

/// The voxels of a column whose materials are chosen at once.
constexpr std::int32_t kColumnPiece = 128;

/// Returns the number of chunks that a box meets.
std::uint64_t chunks_in(const VoxelBox& box, std::int32_t edge) {
  const auto along = [edge](std::int32_t low, std::int32_t end) {
    return static_cast<std::uint64_t>(floor_div(end - 1, edge) - floor_div(low, edge) + 1);
  };
  return along(box.min.x, box.max.x) * along(box.min.y, box.max.y) * along(box.min.z, box.max.z);
}

/// Returns the number of the first section that lies in the next slice along an axis.
std::uint32_t next_slice(const std::vector<std::int32_t>& cuts, std::int32_t first,
                         std::uint32_t section) {
  const std::int32_t slice = floor_div(first + cuts[section], kColumnSliceEdge);
  while (section + 1 < cuts.size() && floor_div(first + cuts[section], kColumnSliceEdge) == slice)
    ++section;
  return section;
}

}  // namespace

Result<Replacing> Replacing::of(const VoxelBox& box, BoundMix mix,
                                std::optional<BoundFilter> filter, std::int32_t chunk_edge,
                                ChunkLookup chunks, VoxelRowsPtr only) {
  RUNSTONE_ASSERT(!box.empty() && chunk_edge > 0);
  auto builder = BuildBuilder::of(world_cuts(box, kPasteBlockEdge));
  if (!builder) return failure(builder.error());
  return Replacing(box, std::move(mix), std::move(filter), chunk_edge, std::move(chunks),
                   std::move(only), *std::move(builder));
}

Replacing::Replacing(const VoxelBox& box, BoundMix mix, std::optional<BoundFilter> filter,
                     std::int32_t chunk_edge, ChunkLookup chunks, VoxelRowsPtr only,
                     BuildBuilder builder)
    : box_(box),
      mix_(std::move(mix)),
      filter_(std::move(filter)),
      chunk_edge_(chunk_edge),
      chunks_(std::move(chunks)),
      only_(std::move(only)),
      builder_(std::move(builder)),
      run_units_(1 + (filter_ ? filter_->conditions() : 0)) {
  slice_high_.x = next_slice(builder_.cuts()[0], box_.min.x, 0);
  slice_high_.z = next_slice(builder_.cuts()[2], box_.min.z, 0);
}

Result<void> Replacing::read_slice(std::uint64_t& work) {
  const BuildCuts& cuts = builder_.cuts();
  const VoxelBox slice{
      {box_.min.x + cuts[0][slice_low_.x], box_.min.y, box_.min.z + cuts[2][slice_low_.z]},
      {box_.min.x + cuts[0][slice_high_.x], box_.max.y, box_.min.z + cuts[2][slice_high_.z]}};
  const VoxelBox read = slice_box(slice, filter_ && filter_->reads_neighbours());
  auto columns = read_column_slice(read, box_, chunk_edge_, chunks_);
  const auto edge = static_cast<std::uint64_t>(chunk_edge_);
  work -= std::min(work, chunks_in(read, chunk_edge_) * edge * edge);
  if (!columns) return failure(columns.error());
  columns_ = *std::move(columns);
  stack_ = slice_low_;
  begin_stack();
  return {};
}

void Replacing::begin_stack() {
  const BuildCuts& cuts = builder_.cuts();
  stack_min_ = {box_.min.x + cuts[0][stack_.x], 0, box_.min.z + cuts[2][stack_.z]};
  stack_max_ = {box_.min.x + cuts[0][stack_.x + 1], 0, box_.min.z + cuts[2][stack_.z + 1]};
  sections_.clear();
  for (std::size_t i = 0; i + 1 < cuts[1].size(); ++i)
    sections_.push_back({{}, box_.min.y + cuts[1][i], box_.min.y + cuts[1][i + 1]});
  x_ = stack_min_.x;
  z_ = stack_min_.z;
  line_ = 0;
}

Result<void> Replacing::put_stack() {
  for (std::uint32_t y = 0; y < sections_.size(); ++y) {
    auto& cells = sections_[y].cells;
    if (!cells) continue;
    cells->append_to(extent_of(sections_[y]).volume(), 0);
    if (auto put = builder_.put({stack_.x, y, stack_.z}, cells->finish()); !put) return put;
  }
  return {};
}

void Replacing::next_stack() {
  if (++stack_.x < slice_high_.x) return begin_stack();
  stack_.x = slice_low_.x;
  if (++stack_.z < slice_high_.z) return begin_stack();
  columns_.reset();
  const BuildCuts& cuts = builder_.cuts();
  slice_low_.x = slice_high_.x;
  if (slice_low_.x + 1 >= cuts[0].size()) {
    slice_low_.x = 0;
    slice_low_.z = slice_high_.z;
    is_done_ = slice_low_.z + 1 >= cuts[2].size();
    if (is_done_) return;
    slice_high_.z = next_slice(cuts[2], box_.min.z, slice_low_.z);
  }
  slice_high_.x = next_slice(cuts[0], box_.min.x, slice_low_.x);
}

Result<bool> Replacing::step(std::uint64_t& work) {
  while (!is_done_ && work > 0) {
    if (!columns_) {
      if (const auto read = read_slice(work); !read) return failure(read.error());
    }
    if (const auto put = put_column(work); !put) return failure(put.error());
    ++line_;
    if (++x_ < stack_max_.x) continue;
    x_ = stack_min_.x;
    if (++z_ < stack_max_.z) continue;
    if (const auto put = put_stack(); !put) return failure(put.error());
    next_stack();
  }
  return is_done_;
}

std::uint64_t Replacing::decided() const {
  return mixed_ + (filter_ ? filter_->noise_voxels() : 0);
}

Result<void> Replacing::put_column(std::uint64_t& work) {
  const auto runs = columns_->column(columns_->index(x_, z_));
  if (runs.empty()) return fail(ErrorCode::not_found, "a chunk of the box is not loaded");
  const std::uint64_t decided_before = decided();
  HeightRanges ranges = {{box_.min.y, box_.max.y}};
  if (filter_) ranges = filter_->passing(*columns_, x_, z_, ranges.front());
  if (only_) ranges = chosen(ranges, work);
  section_ = 0;
  const auto single = mix_.single();
  auto run = runs.begin();
  for (const HeightRange& range : ranges) {
    while (run->end <= range.low) ++run;
    for (std::int32_t low = range.low; low < range.high;) {
      const std::int32_t high = std::min(range.high, run->end);
      if (!single) {
        mix_run({low, high}, run->material);
      } else if (*single != run->material) {
        set(low, high, *single);
      }
      low = high;
      if (low == run->end) ++run;
    }
  }
  if (is_full_) return fail(ErrorCode::limit_exceeded, "too many materials in a build");
  work -= std::min(work, 1 + runs.size() * run_units_ + decided() - decided_before);
  return {};
}

HeightRanges Replacing::chosen(const HeightRanges& ranges, std::uint64_t& work) const {
  HeightRanges out;
  for (const HeightRange& range : ranges) {
    work -= std::min(work, static_cast<std::uint64_t>(range.high - range.low));
    for (std::int32_t y = range.low; y < range.high; ++y) {
      if (only_->contains({x_, y, z_})) append_range(out, y, y + 1);
    }
  }
  return out;
}

/// Sets the voxels of a part of a run whose materials change.
void Replacing::mix_run(HeightRange range, Material old) {
  mixed_ += static_cast<std::uint64_t>(range.high - range.low);
  std::array<Material, kColumnPiece> materials;
  std::int32_t first = range.low;  // of the voxels that get the same material
  std::optional<Material> open;
  for (std::int32_t low = range.low; low < range.high; low += kColumnPiece) {
    const std::int32_t high = std::min(low + kColumnPiece, range.high);
    const std::span<Material> piece =
        std::span(materials).first(static_cast<std::size_t>(high - low));
    mix_.read_column({x_, low, z_}, piece);
    for (std::int32_t y = low; y < high; ++y) {
      const Material next = piece[static_cast<std::size_t>(y - low)];
      if (open == next) continue;
      if (open && *open != old) set(first, y, *open);
      first = y;
      open = next;
    }
  }
  if (open && *open != old) set(first, range.high, *open);
}

/// Sets the voxels [low, high) of the present column. Requires that they lie above those before.
void Replacing::set(std::int32_t low, std::int32_t high, Material material) {
  has_changes_ = true;
  const auto number = builder_.number_of(material);
  if (!number) {
    is_full_ = true;
    return;
  }
  while (low < high) {
    while (sections_[section_].high <= low) ++section_;
    Section& section = sections_[section_];
    const Extent extent = extent_of(section);
    if (!section.cells) section.cells.emplace(extent, AxisOrder::yxz);
    const std::int32_t end = std::min(high, section.high);
    section.cells->append_to(line_ * extent.y + static_cast<std::uint32_t>(low - section.low), 0);
    section.cells->append(static_cast<std::uint32_t>(end - low), *number);
    low = end;
  }
}

Extent Replacing::extent_of(const Section& section) const {
  return {static_cast<std::uint8_t>(stack_max_.x - stack_min_.x),
          static_cast<std::uint8_t>(section.high - section.low),
          static_cast<std::uint8_t>(stack_max_.z - stack_min_.z)};
}

Result<PlacedBuild> Replacing::finish() {
  RUNSTONE_ASSERT(is_done_);
  if (!has_changes_) return PlacedBuild{};
  auto build = builder_.finish();
  if (!build) return failure(build.error());
  return PlacedBuild{box_.min, *std::move(build)};
}

Result<PlacedBuild> replaced(const VoxelBox& box, const BoundMix& mix, const BoundFilter* filter,
                             std::int32_t chunk_edge, const ChunkLookup& chunks) {
  auto replacing = Replacing::of(
      box, mix, filter != nullptr ? std::optional(*filter) : std::nullopt, chunk_edge, chunks);
  if (!replacing) return failure(replacing.error());
  std::uint64_t unbounded = UINT64_MAX;
  if (const auto done = replacing->step(unbounded); !done) return failure(done.error());
  return replacing->finish();
}

}  // namespace runstone
