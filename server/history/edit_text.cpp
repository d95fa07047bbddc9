#include "server/history/edit_text.hpp"

#include "common/core/key_text.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_kind_name.hpp"

namespace runstone {

std::string edit_text(const EditRecord& record, const MaterialTable& materials) {
  const EditKind kind = kind_of(record.edit);
  const VoxelBox box = bounding_box(record.edit);
  std::string out =
      std::string(restores(record.cause) ? "restored" : name_of(kind)) + " " + text_of(box.min);
  const VoxelPos last{box.max.x - 1, box.max.y - 1, box.max.z - 1};
  if (last != box.min) out += " to " + text_of(last);
  if (!restores(record.cause) && kind != EditKind::paste && materials.knows(record.edit.material))
    out += " := " + materials[record.edit.material].name;
  return out;
}

}  // namespace runstone
