#include "server/import/import_builds.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

#include "common/builds/build_transforms.hpp"
#include "common/formats/file_build.hpp"
#include "common/formats/material_match.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

VoxelBox around(const VoxelBox& a, const VoxelBox& b) {
  if (a.empty()) return b;
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

VoxelBox moved(const VoxelBox& box, VoxelPos by, int sign) {
  return {{box.min.x + sign * by.x, box.min.y + sign * by.y, box.min.z + sign * by.z},
          {box.max.x + sign * by.x, box.max.y + sign * by.y, box.max.z + sign * by.z}};
}

/// The cells that are looked at for the place where players arrive.
constexpr std::uint32_t kLooksMax = 1'000'000;
/// The memory of a build with the ids of the world.
constexpr std::size_t kIdsBytesMax = std::size_t{4} << 30;
/// The chunks that the box of a part may have.
constexpr std::uint64_t kChunksMax = std::uint64_t{1} << 26;

/// Returns the chunks from the lowest to the highest one that a box meets, both inside.
std::pair<ChunkCoord, ChunkCoord> chunks_of(const VoxelBox& box, std::int32_t edge) {
  return {chunk_of(box.min, edge), chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge)};
}

std::uint64_t count_of(const std::pair<ChunkCoord, ChunkCoord>& chunks) {
  const auto& [first, last] = chunks;
  const auto side = [](std::int32_t a, std::int32_t b) {
    return static_cast<std::uint64_t>(b - a) + 1;
  };
  return side(first.x, last.x) * side(first.y, last.y) * side(first.z, last.z);
}

/// Returns the place above the highest voxel that is not empty in the middle column of a part, or in
/// the column nearest to it along x and z that has one; the top of the box if these have none.
VoxelPos top_of_middle(const FileBuild& build, const VoxelBox& box) {
  const VoxelPos sides = build.build->sides();
  std::uint32_t looks = 0;
  const auto top = [&](std::int32_t x, std::int32_t z) -> std::optional<std::int32_t> {
    for (std::int32_t y = sides.y - 1; y >= 0 && looks < kLooksMax; --y, ++looks) {
      const auto material = build.build->at({x, y, z});
      if (material && *material != kEmpty) return y + 1;
    }
    return std::nullopt;
  };
  const std::int32_t x = sides.x / 2, z = sides.z / 2;
  const std::int32_t reach = std::max(x, z);
  for (std::int32_t away = 0; away <= reach && looks < kLooksMax; ++away) {
    const std::array<std::pair<std::int32_t, std::int32_t>, 4> columns = {
        {{x + away, z}, {x - away, z}, {x, z + away}, {x, z - away}}};
    for (const auto& [at_x, at_z] : columns) {
      if (at_x < 0 || at_x >= sides.x || at_z < 0 || at_z >= sides.z) continue;
      if (const auto y = top(at_x, at_z))
        return {box.min.x + at_x, box.min.y + *y, box.min.z + at_z};
    }
  }
  return {box.min.x + x, box.max.y, box.min.z + z};
}

/// Returns the lowest place at or above `at` where a player, who is two voxels high, does not stand
/// in a voxel of a part.
VoxelPos raised_from(VoxelPos at, const FileBuild& build, const VoxelBox& box) {
  if (!box.contains({at.x, box.min.y, at.z})) return at;
  const auto is_solid = [&](std::int32_t y) {
    if (y < box.min.y || y >= box.max.y) return false;
    const auto material = build.build->at({at.x - box.min.x, y - box.min.y, at.z - box.min.z});
    return material && *material != kEmpty;
  };
  while (at.y < box.max.y && (is_solid(at.y) || is_solid(at.y + 1))) ++at.y;
  return at;
}

/// Returns the place on top of the part that is nearest to the middle of all.
VoxelPos spawn_of(const VoxelBox& bounds, const std::vector<VoxelPos>& tops) {
  const auto distance = [&](const VoxelPos& top) {
    const std::int64_t x = std::int64_t{top.x} * 2 - bounds.min.x - bounds.max.x;
    const std::int64_t z = std::int64_t{top.z} * 2 - bounds.min.z - bounds.max.z;
    return std::abs(x) + std::abs(z);
  };
  return *std::min_element(tops.begin(), tops.end(), [&](const VoxelPos& a, const VoxelPos& b) {
    return distance(a) < distance(b);
  });
}

/// Returns a build of the ids of a table.
Result<BuildPtr, std::string> with_ids(const FileBuild& build, const MaterialTable& table) {
  const MaterialMatch match = match_by_name(build.materials, table);
  if (!match.missing.empty()) return failure("it changed while it was read: import a copy");
  auto made = with_materials(*build.build, match.ids, kIdsBytesMax);
  if (!made) return failure(std::string(made.error().what));
  return *std::move(made);
}

}  // namespace

Result<BuildsSurvey, std::string> survey_builds(ImportParts& parts,
                                                const ImportProgress& progress) {
  BuildsSurvey survey;
  std::map<std::string, MaterialRow> rows;
  std::vector<VoxelPos> tops;
  ImportFaults faults;  // the second pass finds them again
  std::optional<VoxelPos> spawn = parts.spawn();
  for (std::size_t i = 0; i < parts.count(); ++i) {
    if (progress) progress(i, 2 * parts.count());
    const auto part = parts.read(i, faults);
    if (!part) return failure(part.error());
    if (!*part || solid_cells((*part)->build) == 0) continue;
    const FileBuild& build = (*part)->build;
    for (const BuildMaterial& material : build.materials) {
      if (material.row.visibility == Visibility::empty) continue;
      MaterialRow row = world_row_of(material);
      rows.try_emplace(row.name, row);
    }
    const VoxelBox box = moved(build.build->box(), (*part)->at, 1);
    survey.bounds = around(survey.bounds, box);
    tops.push_back(top_of_middle(build, box));
    if (spawn) spawn = raised_from(*spawn, build, box);
  }
  if (tops.empty()) {
    return failure("nothing but empty voxels is in it" +
                   (faults.empty() ? std::string() : "; " + faults.front()));
  }
  const VoxelBox& all = survey.bounds;
  const bool is_inside = spawn && all.contains({spawn->x, all.min.y, spawn->z});
  survey.spawn = is_inside ? *spawn : spawn_of(all, tops);
  for (auto& [name, row] : rows) {
    const auto added = survey.materials.add(
        {row.name, row.colour, row.visibility, std::nullopt, row.body, row.look, row.shape});
    if (!added) {
      return failure("its " + std::to_string(rows.size()) + " materials: " + name + ": " +
                     added.error().what);
    }
  }
  return survey;
}

Result<BuildsReport, std::string> import_builds(ImportParts& parts, const MaterialTable& materials,
                                                std::int32_t edge, const ImportedChunk& chunk,
                                                const ImportProgress& progress) {
  BuildsReport report;
  for (std::size_t i = 0; i < parts.count(); ++i) {
    if (progress) progress(parts.count() + i, 2 * parts.count());
    const auto part = parts.read(i, report.faults);
    if (!part) return failure(part.error());
    if (!*part || solid_cells((*part)->build) == 0) continue;
    const auto build = with_ids((*part)->build, materials);
    if (!build) return failure(build.error());
    ++report.parts;
    const VoxelPos at = (*part)->at;
    const auto chunks = chunks_of(moved((*build)->box(), at, 1), edge);
    if (count_of(chunks) > kChunksMax) {
      return failure("its box has " + std::to_string(count_of(chunks)) + " chunks of edge " +
                     std::to_string(edge) + ", and at most " + std::to_string(kChunksMax) +
                     " are imported");
    }
    const auto& [first, last] = chunks;
    for (ChunkCoord c = first; c.z <= last.z; ++c.z) {
      for (c.y = first.y; c.y <= last.y; ++c.y) {
        for (c.x = first.x; c.x <= last.x; ++c.x) {
          RunChunk voxels = materials_in(**build, moved(box_of(c, edge), at, -1));
          if (voxels.is_uniform() && voxels.runs.material(0) == kEmpty) continue;
          voxels = in_cheapest_order(std::move(voxels));
          ++report.chunks;
          report.runs += voxels.runs.size();
          if (!chunk({0, c}, std::move(voxels))) return failure("the world cannot be written");
        }
      }
    }
    report.voxels += (*build)->solid();
  }
  return report;
}

}  // namespace runstone
