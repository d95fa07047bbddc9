#include "common/sculpt/column_changes.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/builds/paste_source.hpp"
#include "common/core/assert.hpp"
#include "common/runs/run_builder.hpp"
#include "common/sculpt/column_writer.hpp"

namespace runstone {
namespace {

/// Returns how many voxels of ground lie without a gap from `surface` down to `bottom`, at most
/// `most`.
std::int32_t ground_depth(const ColumnWriter& column, std::int32_t surface, std::int32_t bottom,
                          std::int32_t most, const GroundMaterials& materials) {
  std::int32_t count = 0;
  while (count < most && surface - count >= bottom &&
         materials.is_ground(column.old(surface - count)))
    ++count;
  return count;
}

class SurfaceMove {
 public:
  /// Requires a surface in the box with two voxels above it.
  SurfaceMove(ColumnWriter& column, std::int32_t bottom, std::int32_t from,
              const GroundMaterials& materials)
      : column_(column), from_(from), materials_(materials) {
    skin_ = ground_depth(column, from, bottom, kSkinVoxels, materials);
    below_skin_ = ground_depth(column, from, bottom, skin_ + 1, materials) > skin_
                      ? column.old(from - skin_)
                      : column.old(from - skin_ + 1);
    standing_ = standing_on(column, from, materials);
  }

  void rise(std::int32_t to) {
    for (std::int32_t y = from_ - skin_ + 1; y <= to; ++y) {
      const bool is_free = y <= from_ || materials_.is_open(column_.old(y)) ||
                           (y == from_ + 1 && standing_.is_plant);
      if (!is_free) continue;
      column_.set(y, y <= to - skin_ ? below_skin_ : column_.old(y - (to - from_)));
    }
    if (standing_.is_plant && materials_.is_open(column_.old(to + 1)))
      column_.set(to + 1, standing_.above);
  }

  void sink(std::int32_t to) {
    for (std::int32_t y = to - skin_ + 1; y <= from_; ++y) {
      if (!materials_.is_ground(column_.old(y))) continue;
      if (y <= to) {
        column_.set(y, column_.old(y + (from_ - to)));
      } else {
        column_.set(y, y == to + 1 && standing_.is_plant ? standing_.above : standing_.rest);
      }
    }
    if (standing_.is_plant) column_.set(from_ + 1, kEmpty);
  }

 private:
  ColumnWriter& column_;
  const std::int32_t from_;
  const GroundMaterials& materials_;
  std::int32_t skin_ = 0;         // voxels of ground that move with the surface, at least 1
  Material below_skin_ = kEmpty;  // fills the gap where the ground rises
  Standing standing_;             // moves with the surface if it is a plant
};

/// Returns the box of the changes. Requires at least one.
VoxelBox box_of_changes(const GroundColumns& columns, const ColumnChanges& changes) {
  VoxelBox box;
  for (const ColumnChange& change : changes) {
    const auto width = static_cast<std::size_t>(columns.width());
    const std::int32_t x = columns.box().min.x + static_cast<std::int32_t>(change.column % width);
    const std::int32_t z = columns.box().min.z + static_cast<std::int32_t>(change.column / width);
    box = bounding_box(box, {{x, change.low, z}, {x + 1, change.high, z + 1}});
  }
  return box;
}

/// Makes the sections of a build from changes.
class SectionMaker {
 public:
  SectionMaker(const GroundColumns& columns, const ColumnChanges& changes, const VoxelBox& box,
               BuildBuilder& builder)
      : columns_(columns), changes_(changes), box_(box), builder_(builder) {
    first_.assign(columns.count() + 1, 0);
    for (const ColumnChange& change : changes) ++first_[change.column + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  }

  /// Returns the section [low, high) as runs of cell numbers along y, or nullopt if nothing in it
  /// changes. Fails if the palette is full.
  Result<std::optional<RunChunk>> make(VoxelPos low, VoxelPos high) {
    const Extent extent{static_cast<std::uint8_t>(high.x - low.x),
                        static_cast<std::uint8_t>(high.y - low.y),
                        static_cast<std::uint8_t>(high.z - low.z)};
    RunBuilder out(extent, AxisOrder::yxz);
    bool is_touched = false;
    std::uint32_t line = 0;
    for (std::int32_t z = low.z; z < high.z; ++z) {
      for (std::int32_t x = low.x; x < high.x; ++x, line += extent.y) {
        const std::size_t column = columns_.index(x, z);
        for (std::size_t i = first_[column]; i < first_[column + 1]; ++i) {
          const ColumnChange& change = changes_[i];
          const std::int32_t from = std::max(change.low, low.y), to = std::min(change.high, high.y);
          if (from >= to) continue;
          const auto number = builder_.number_of(change.material);
          if (!number) return fail(ErrorCode::limit_exceeded, "too many materials in a build");
          out.append_to(line + static_cast<std::uint32_t>(from - low.y), 0);
          out.append(static_cast<std::uint32_t>(to - from), *number);
          is_touched = true;
        }
      }
    }
    if (!is_touched) return std::optional<RunChunk>();
    out.append_to(extent.volume(), 0);
    return std::optional<RunChunk>(out.finish());
  }

  Result<void> put_all() {
    const BuildCuts cuts = builder_.cuts();
    for (std::uint32_t z = 0; z + 1 < cuts[2].size(); ++z) {
      for (std::uint32_t y = 0; y + 1 < cuts[1].size(); ++y) {
        for (std::uint32_t x = 0; x + 1 < cuts[0].size(); ++x) {
          auto cells =
              make({box_.min.x + cuts[0][x], box_.min.y + cuts[1][y], box_.min.z + cuts[2][z]},
                   {box_.min.x + cuts[0][x + 1], box_.min.y + cuts[1][y + 1],
                    box_.min.z + cuts[2][z + 1]});
          if (!cells) return failure(cells.error());
          if (!*cells) continue;
          if (const auto put = builder_.put({x, y, z}, std::move(**cells)); !put)
            return failure(put.error());
        }
      }
    }
    return {};
  }

 private:
  const GroundColumns& columns_;
  const ColumnChanges& changes_;
  const VoxelBox box_;
  BuildBuilder& builder_;
  std::vector<std::size_t> first_;  // change by column, and the number of all
};

}  // namespace

void move_surface(const GroundColumns& columns, std::size_t column, std::int32_t from,
                  std::int32_t to, const GroundMaterials& materials, ColumnChanges& out) {
  const VoxelBox& box = columns.box();
  if (from == kNoSurface || from + 2 >= box.max.y) return;
  to = std::min(to, box.max.y - 2);
  // A surface that sinks leaves room for its skin in the box.
  if (to < from) to = std::min(from, std::max(to, box.min.y + kSkinVoxels));
  if (to == from) return;
  ColumnWriter writer(columns, column, out);
  SurfaceMove move(writer, box.min.y, from, materials);
  if (to > from) {
    move.rise(to);
  } else {
    move.sink(to);
  }
}

void set_layers(const GroundColumns& columns, std::size_t column, std::int32_t surface,
                std::span<const Material> layers, const GroundMaterials& materials,
                ColumnChanges& out) {
  if (surface == kNoSurface) return;
  ColumnWriter writer(columns, column, out);
  const std::int32_t depth = ground_depth(writer, surface, columns.box().min.y,
                                          static_cast<std::int32_t>(layers.size()), materials);
  for (std::int32_t i = depth; i-- > 0;)
    writer.set(surface - i, layers[static_cast<std::size_t>(i)]);
}

Result<PlacedBuild> build_of_changes(const GroundColumns& columns, const ColumnChanges& changes) {
  if (changes.empty()) return PlacedBuild{};
  const VoxelBox box = box_of_changes(columns, changes);
  auto builder = BuildBuilder::of(world_cuts(box, kPasteBlockEdge));
  if (!builder) return failure(builder.error());
  SectionMaker maker(columns, changes, box, *builder);
  if (const auto put = maker.put_all(); !put) return failure(put.error());
  auto build = builder->finish();
  if (!build) return failure(build.error());
  return PlacedBuild{box.min, *std::move(build)};
}

}  // namespace runstone
