#include "client/tools/ground_stroke.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "client/tools/action_source.hpp"
#include "client/tools/build_words.hpp"
#include "client/tools/typed_pattern.hpp"
#include "common/patterns/column_patterns.hpp"
#include "common/sculpt/path_brush.hpp"
#include "common/sculpt/terrain_brush.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

static_assert(kTerrainModeMax + 1 == kBrushModeCount && kFalloffMax + 1 == kBrushFalloffCount &&
                  kPathModeMax == static_cast<int>(PathHeight::even) &&
                  kTerrainSizeMax == kBrushRadiusMax && kTerrainStrengthMax == kBrushStrengthMax &&
                  kPathSizeMax == kPathWidthMax && kBrushTextBytesMax == kToolTextBytesMax,
              "the ranges of the protocol are those of the brushes");

/// Returns a text of a stroke as a pattern with the materials of this world. Fails with words for
/// the player.
Result<TypedPattern, std::string> pattern_of(const char* name, ToolText::Kind kind,
                                             const std::string& text, const MaterialTable& table,
                                             const PatternFrame& frame) {
  ToolText typed{name, "", kind};
  typed.text = text;
  return typed_pattern(typed, table, frame);
}

/// Returns a bound of the work of the filter and the mix: a noise and a mix take the voxels one by
/// one, and each condition and each part has bytes in its text.
std::uint64_t pattern_work(const BrushStroke& stroke, const ColumnChanges& changes) {
  std::uint64_t voxels = 0;
  for (const ColumnChange& change : changes)
    voxels += static_cast<std::uint64_t>(std::int64_t{change.high} - change.low);
  return voxels * (stroke.where.size() + stroke.mix.size());
}

}  // namespace

Result<GroundColumns, std::string> read_shown_ground(const Replica& replica, VoxelBox box,
                                                     VoxelPos place, UprightChunks& upright) {
  const std::int32_t edge = replica.chunk_edge();
  const ChunkCoord middle = chunk_of(place, edge);
  const auto is_shown = [&](std::int32_t y) {
    return replica.shown({0, {middle.x, y, middle.z}}) != nullptr;
  };
  if (!is_shown(middle.y)) return failure("the ground is not loaded here");
  std::int32_t low = middle.y, high = middle.y;
  while (low * edge > box.min.y && is_shown(low - 1)) --low;
  while ((high + 1) * edge < box.max.y && is_shown(high + 1)) ++high;
  box.min.y = std::max(box.min.y, low * edge);
  box.max.y = std::min(box.max.y, (high + 1) * edge);
  upright.begin_plan();
  auto columns = GroundColumns::read(box, edge, [&](ChunkCoord coord) {
    auto chunk = replica.shown({0, coord});
    return chunk ? upright.of(chunk) : chunk;
  });
  if (!columns)
    return failure(std::string(columns.error().what) +
                   ": make a shorter stroke, or choose a smaller radius or width");
  return *std::move(columns);
}

ToolEdits edits_of_stroke(const BrushStroke& stroke, const Replica& replica,
                          const MaterialTable& table, UprightChunks& upright,
                          std::uint64_t pattern_work_max) {
  const VoxelPos first = stroke.places.front();
  const PatternFrame frame{stroke.seed, {2 * first.x, 2 * first.y, 2 * first.z}};
  auto where = pattern_of("where", ToolText::Kind::filter, stroke.where, table, frame);
  if (!where) return failure(where.error());
  auto mix = pattern_of("material", ToolText::Kind::mix, stroke.mix, table, frame);
  if (!mix) return failure(mix.error());
  const Material material = stroke.mix.empty() ? stroke.material : kMixedMaterial;
  const GroundMaterials materials = GroundMaterials::of(table);
  std::optional<GroundColumns> columns;
  ColumnChanges changes;
  if (stroke.brush == BrushKind::terrain) {
    TerrainBrush brush;
    brush.mode = static_cast<BrushMode>(stroke.mode);
    brush.falloff = static_cast<BrushFalloff>(stroke.falloff);
    brush.radius = stroke.size;
    brush.strength = stroke.strength;
    brush.lowers = stroke.lowers;
    brush.material = material;
    brush.seed = stroke.seed;
    auto read = read_shown_ground(replica, brush_box(brush, stroke.places), first, upright);
    if (!read) return failure(read.error());
    columns = *std::move(read);
    changes = brush_changes(*columns, materials, brush, stroke.places);
  } else {
    PathBrush brush;
    brush.width = stroke.size;
    brush.height = static_cast<PathHeight>(stroke.mode);
    brush.material = material;
    const auto curve = curve_through(stroke.places);
    auto read = read_shown_ground(replica, path_box(brush, curve), first, upright);
    if (!read) return failure(read.error());
    columns = *std::move(read);
    changes = path_changes(*columns, materials, brush, curve);
  }
  if (pattern_work(stroke, changes) > pattern_work_max)
    return failure("the filter and the mix of the stroke are too much work for a preview");
  if (where->filter) changes = filtered(*columns, changes, *where->filter);
  if (mix->mix) changes = mixed(*columns, changes, *mix->mix);
  const auto placed = build_of_changes(*columns, changes);
  if (!placed) return failure(words_of(placed.error()));
  if (!placed->build) return failure("there is no ground to change here");
  const bool is_difference = stroke.mask.kind == MaskKind::everything;
  return paste_of_build({placed->build, placed->at, stroke.mask, EmptyCells::pasted, is_difference},
                        replica.edit_limits());
}

}  // namespace runstone
