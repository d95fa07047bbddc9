#include "common/patterns/replaced.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "common/builds/build_builder.hpp"
#include "common/builds/paste_source.hpp"
#include "common/core/assert.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// The sides of the area of columns that is read at a time. Its borders are borders of sections.
constexpr std::int32_t kSliceEdge = 256;
static_assert(kSliceEdge % kPasteBlockEdge == 0 &&
              std::int64_t{kSliceEdge + 2} * (kSliceEdge + 2) <= kGroundColumnsMax);
/// The material of voxels around the box that are not known. The last id is that of a material only
/// in a table that is full; a filter that names it may match there.
constexpr Material kUnknownMaterial = UINT16_MAX;

std::int32_t block_offset(std::int32_t at) {
  return at - floor_div(at, kPasteBlockEdge) * kPasteBlockEdge;
}

VoxelBox widened_in_world(const VoxelBox& box) {
  const VoxelBox world{{-kWorldLimit, -kWorldLimit, -kWorldLimit},
                       {kWorldLimit, kWorldLimit, kWorldLimit}};
  return intersect({{box.min.x - 1, box.min.y - 1, box.min.z - 1},
                    {box.max.x + 1, box.max.y + 1, box.max.z + 1}},
                   world);
}

class Replacement {
 public:
  Replacement(const VoxelBox& box, BoundMix& mix, BoundFilter* filter, BuildBuilder& builder)
      : box_(box), mix_(mix), filter_(filter), builder_(builder), cuts_(builder.cuts()) {}

  /// Puts the sections of the slice whose columns were read. The numbers of sections along x and z
  /// are [low, high).
  Result<void> put(const GroundColumns& columns, SectionPos low, SectionPos high) {
    for (std::uint32_t z = low.z; z < high.z; ++z) {
      for (std::uint32_t x = low.x; x < high.x; ++x) {
        if (const auto done = put_stack(columns, x, z); !done) return done;
      }
    }
    return {};
  }
  /// Returns true if a voxel changes.
  bool has_changes() const { return has_changes_; }

 private:
  /// The section of the stack that is made, and its place.
  struct Section {
    std::optional<RunBuilder> cells;  // nullopt: nothing in it changes yet
    std::int32_t low = 0, high = 0;   // its heights in the world
  };

  Result<void> put_stack(const GroundColumns& columns, std::uint32_t sx, std::uint32_t sz) {
    const VoxelPos low{box_.min.x + cuts_[0][sx], 0, box_.min.z + cuts_[2][sz]};
    const VoxelPos high{box_.min.x + cuts_[0][sx + 1], 0, box_.min.z + cuts_[2][sz + 1]};
    sections_.clear();
    for (std::size_t i = 0; i + 1 < cuts_[1].size(); ++i)
      sections_.push_back({{}, box_.min.y + cuts_[1][i], box_.min.y + cuts_[1][i + 1]});
    width_ = high.x - low.x;
    depth_ = high.z - low.z;
    line_ = 0;
    for (std::int32_t z = low.z; z < high.z; ++z) {
      for (std::int32_t x = low.x; x < high.x; ++x, ++line_) {
        if (const auto done = put_column(columns, x, z); !done) return done;
      }
    }
    for (std::uint32_t sy = 0; sy < sections_.size(); ++sy) {
      auto& cells = sections_[sy].cells;
      if (!cells) continue;
      cells->append_to(extent_of(sections_[sy]).volume(), 0);
      if (const auto put = builder_.put({sx, sy, sz}, cells->finish()); !put)
        return failure(put.error());
    }
    return {};
  }

  Result<void> put_column(const GroundColumns& columns, std::int32_t x, std::int32_t z) {
    const auto runs = columns.column(columns.index(x, z));
    if (runs.empty()) return fail(ErrorCode::not_found, "a chunk of the box is not loaded");
    HeightRanges ranges = {{box_.min.y, box_.max.y}};
    if (filter_ != nullptr) ranges = filter_->passing(columns, x, z, ranges.front());
    section_ = 0;
    const auto single = mix_.single();
    auto run = runs.begin();
    for (const HeightRange& range : ranges) {
      while (run->end <= range.low) ++run;
      for (std::int32_t low = range.low; low < range.high;) {
        const std::int32_t high = std::min(range.high, run->end);
        if (!single) {
          mix_run(x, z, {low, high}, run->material);
        } else if (*single != run->material) {
          set(low, high, *single);
        }
        low = high;
        if (low == run->end) ++run;
      }
    }
    if (is_full_) return fail(ErrorCode::limit_exceeded, "too many materials in a build");
    const std::uint64_t noise = filter_ != nullptr ? filter_->noise_voxels() : 0;
    if (mixed_ + noise > kPatternVoxelsMax)
      return fail(ErrorCode::limit_exceeded, "more than 33,554,432 voxels are mixed");
    return {};
  }

  /// Sets the voxels of a part of a run whose materials change.
  void mix_run(std::int32_t x, std::int32_t z, HeightRange range, Material old) {
    mixed_ += static_cast<std::uint64_t>(range.high - range.low);
    std::int32_t first = range.low;  // of the voxels that get the same material
    Material material = mix_.at({x, first, z});
    for (std::int32_t y = range.low + 1; y <= range.high; ++y) {
      const Material next = y < range.high ? mix_.at({x, y, z}) : material;
      if (y < range.high && next == material) continue;
      if (material != old) set(first, y, material);
      first = y;
      material = next;
    }
  }

  /// Sets the voxels [low, high) of the present column. Requires that they lie above those before.
  void set(std::int32_t low, std::int32_t high, Material material) {
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
  Extent extent_of(const Section& section) const {
    return {static_cast<std::uint8_t>(width_),
            static_cast<std::uint8_t>(section.high - section.low),
            static_cast<std::uint8_t>(depth_)};
  }

  const VoxelBox box_;
  BoundMix& mix_;
  BoundFilter* const filter_;
  BuildBuilder& builder_;
  const BuildCuts cuts_;
  std::vector<Section> sections_;       // of the stack, from below to above
  std::int32_t width_ = 0, depth_ = 0;  // of the stack
  std::uint32_t line_ = 0;              // the number of the column in the stack
  std::size_t section_ = 0;             // that holds the voxel that was set last in the column
  std::uint64_t mixed_ = 0;
  bool has_changes_ = false;
  bool is_full_ = false;  // the palette has no room
};

/// Returns the number of the first section that lies in the next slice along an axis.
std::uint32_t next_slice(const std::vector<std::int32_t>& cuts, std::int32_t first,
                         std::uint32_t section) {
  const std::int32_t slice = floor_div(first + cuts[section], kSliceEdge);
  while (section + 1 < cuts.size() && floor_div(first + cuts[section], kSliceEdge) == slice)
    ++section;
  return section;
}

}  // namespace

Result<PlacedBuild> replaced(const VoxelBox& box, BoundMix& mix, BoundFilter* filter,
                             std::int32_t chunk_edge, const ChunkLookup& chunks) {
  RUNSTONE_ASSERT(!box.empty());
  auto builder = BuildBuilder::of(
      {grid_cuts(box.max.x - box.min.x, kPasteBlockEdge, block_offset(box.min.x)),
       grid_cuts(box.max.y - box.min.y, kPasteBlockEdge, block_offset(box.min.y)),
       grid_cuts(box.max.z - box.min.z, kPasteBlockEdge, block_offset(box.min.z))});
  if (!builder) return failure(builder.error());
  const bool is_wide = filter != nullptr && filter->reads_neighbours();
  const auto around = [&](ChunkCoord at) {
    auto chunk = chunks(at);
    if (chunk != nullptr || !intersect(box_of(at, chunk_edge), box).empty()) return chunk;
    return std::shared_ptr<const RunChunk>(std::make_shared<RunChunk>(
        uniform_chunk(Extent::cube(static_cast<std::uint8_t>(chunk_edge)), kUnknownMaterial)));
  };
  Replacement replacement(box, mix, filter, *builder);
  const BuildCuts cuts = builder->cuts();
  SectionPos low, high;
  for (; low.z + 1 < cuts[2].size(); low.z = high.z) {
    high.z = next_slice(cuts[2], box.min.z, low.z);
    for (low.x = 0; low.x + 1 < cuts[0].size(); low.x = high.x) {
      high.x = next_slice(cuts[0], box.min.x, low.x);
      const VoxelBox slice{{box.min.x + cuts[0][low.x], box.min.y, box.min.z + cuts[2][low.z]},
                           {box.min.x + cuts[0][high.x], box.max.y, box.min.z + cuts[2][high.z]}};
      const auto columns =
          GroundColumns::read(is_wide ? widened_in_world(slice) : slice, chunk_edge, around);
      if (!columns) return failure(columns.error());
      if (const auto put = replacement.put(*columns, low, high); !put) return failure(put.error());
    }
  }
  if (!replacement.has_changes()) return PlacedBuild{};
  auto build = builder->finish();
  if (!build) return failure(build.error());
  return PlacedBuild{box.min, *std::move(build)};
}

}  // namespace runstone
