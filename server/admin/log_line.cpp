#include "server/admin/log_line.hpp"

#include "common/core/key_text.hpp"
#include "common/core/utc_text.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/admin/command.hpp"
#include "server/admin/material_file.hpp"
#include "server/admin/rights_change_text.hpp"

namespace runstone {
namespace {

const char* name_of(EditKind kind) {
  switch (kind) {
    case EditKind::set_voxel:
      return "voxel";
    case EditKind::fill_box:
      return "box";
    case EditKind::fill_sphere:
      return "sphere";
    case EditKind::fill_stroke:
      return "stroke";
    case EditKind::paste:
      return "paste";
    case EditKind::rights:
      return "rights";
    case EditKind::materials:
    case EditKind::materials_with_looks:
      return "materials";
  }
  return "?";
}

/// Returns true if the edit restores earlier voxels. It is a paste by its kind, which says nothing
/// about the edit that it takes back.
bool restores(Cause cause) {
  return cause == Cause::undo || cause == Cause::redo || cause == Cause::rollback;
}

}  // namespace

std::string log_line(const EditRecord& record, const std::string& author,
                     const MaterialTable& materials) {
  std::string line =
      std::to_string(record.version.seq) + " " + utc_text(record.time_us) + " " + author + " ";
  line += name_of(record.cause);
  if (record.subject != 0)
    line += (restores(record.cause) ? " of " : " with ") + std::to_string(record.subject);
  if (const RightsChange* change = rights_change_of(record.edit))
    return line + " " + rights_change_text(*change);
  if (const AddedMaterials* added = added_materials_of(record.edit))
    return line + " " + added_materials_text(*added);
  const VoxelBox box = bounding_box(record.edit);
  const EditKind kind = kind_of(record.edit);
  line += std::string(" ") + (restores(record.cause) ? "restored" : name_of(kind)) + " " +
          text_of(box.min);
  const VoxelPos last{box.max.x - 1, box.max.y - 1, box.max.z - 1};
  if (last != box.min) line += " to " + text_of(last);
  if (!restores(record.cause) && kind != EditKind::paste && materials.knows(record.edit.material)) {
    line += " := " + materials[record.edit.material].name;
  }
  return line;
}

}  // namespace runstone
