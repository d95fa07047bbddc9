#include "server/admin/log_line.hpp"

#include "common/core/utc_text.hpp"
#include "server/admin/command.hpp"
#include "server/admin/material_file.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/history/edit_text.hpp"

namespace runstone {

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
  return line + " " + edit_text(record, materials);
}

}  // namespace runstone
