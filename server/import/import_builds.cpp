#include "server/import/import_builds.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "common/builds/build_transforms.hpp"
#include "common/formats/material_match.hpp"
#include "common/runs/column_tops.hpp"
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

/// Returns y above the highest voxel of a column of the build that is not empty, or nullopt.
std::optional<std::int32_t> top_of(const Build& build, std::int32_t x, std::int32_t z) {
  for (std::int32_t y = build.sides().y - 1; y >= 0; --y) {
    const auto material = build.at({x, y, z});
    if (material && *material != kEmpty) return y + 1;
  }
  return std::nullopt;
}

/// Returns a build of the ids of a table, or the name of a material that the table lacks.
Result<BuildPtr, std::string> with_ids(const FileBuild& build, const MaterialTable& table) {
  const MaterialMatch match = match_by_name(build.materials, table);
  if (!match.missing.empty()) return failure(world_name_of(build.materials[match.missing[0]]));
  auto made = with_materials(*build.build, match.ids);
  if (!made) return failure(std::string(made.error().what));
  return *std::move(made);
}

}  // namespace

Result<BuildsReport, std::string> survey_builds(ImportParts& parts, std::int32_t edge,
                                                const ImportProgress& progress) {
  BuildsReport report;
  std::map<std::string, MaterialRow> rows;
  std::vector<VoxelBox> boxes;
  for (std::size_t i = 0; i < parts.count(); ++i) {
    if (progress) progress(i, 2 * parts.count());
    const auto part = parts.read(i, report.faults);
    if (!part) return failure(part.error());
    if (!*part || (*part)->build.build->solid() == 0) continue;
    const FileBuild& build = (*part)->build;
    for (const BuildMaterial& material : build.materials) {
      if (material.row.visibility == Visibility::empty) continue;
      MaterialRow row = world_row_of(material);
      std::string name = row.name;
      rows.try_emplace(std::move(name), std::move(row));
    }
    ++report.parts;
    report.bounds = around(report.bounds, moved(build.build->box(), (*part)->at, 1));
    report.voxels += build.build->solid();
    // Chunks are counted in the second pass.
    static_cast<void>(edge);
  }
  if (report.parts == 0) return failure("nothing but empty voxels is in it");
  for (auto& [name, row] : rows) {
    const auto added = report.materials.add({row.name, row.colour, row.visibility, std::nullopt,
                                             row.body, row.look});
    if (!added) {
      return failure("its " + std::to_string(rows.size()) + " materials: " + name + ": " +
                     added.error().what);
    }
  }
  return report;
}

}  // namespace runstone
