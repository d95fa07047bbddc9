// Material handlers: materials that are added to the world while people play. The table in force is
// that of the world's start and what records of the log added since.
#pragma once
#include <vector>

#include "common/edits/descriptor/edit_record.hpp"
#include "server/world/added_at.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// Orders the addition of materials by the console, as one record of the log: all or none. Refuses
/// bad rows (MaterialTable::check_rows()), none or more than kAddedMaterialsMax of them, and while
/// the log takes no edits.
Result<AddedAt, MaterialsRefusal> add_materials(WorldState& world,
                                                const std::vector<MaterialRow>& rows,
                                                const Clocks& now);
/// Takes over the materials among these records, which were ordered just now, and sends them to all
/// open sessions.
void apply_materials(WorldState& world, const std::vector<EditRecord>& records);
/// Sends the materials that an open session lacks. Closes a session without the feature, and one
/// whose queue is full.
void send_materials(WorldState& world, SessionId session);

}  // namespace runstone
