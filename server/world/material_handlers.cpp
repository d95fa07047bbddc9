#include "server/world/material_handlers.hpp"

#include <algorithm>

#include "server/world/server_edits.hpp"

namespace runstone {
namespace {

Unexpected<MaterialsRefusal> refusal(std::string what,
                                     std::optional<std::size_t> row = std::nullopt) {
  return {{std::move(what), row}};
}

/// Returns the rows of the table from `first` on, as many as one record may have.
MaterialsAdded rows_from(const MaterialTable& table, std::size_t first) {
  const auto rows = table.rows().subspan(first, std::min(table.size() - first, kAddedMaterialsMax));
  MaterialsAdded message;
  message.first = static_cast<Material>(first);
  for (const MaterialInfo& info : rows) message.rows.push_back(row_of(info));
  return message;
}

}  // namespace

Result<AddedAt, MaterialsRefusal> add_materials(WorldState& world,
                                                const std::vector<MaterialRow>& rows,
                                                const Clocks& now) {
  const MaterialTable& table = world.config.materials;
  if (rows.empty() || rows.size() > kAddedMaterialsMax) {
    return refusal(std::to_string(rows.size()) + " materials: 1 to " +
                   std::to_string(kAddedMaterialsMax) + " can be added at a time");
  }
  if (const auto sound = table.check_rows(rows); !sound)
    return refusal(sound.error().what, static_cast<std::size_t>(sound.error().offset));
  const auto first = static_cast<Material>(table.size());
  const OperationId op{0, world.change_instance, ++world.change_client_seq};
  const EditOffer offer{op, Cause::materials, now.steady_us, materials_edit({first, rows}), 0};
  const ServerEditsResult ordered = order_server_edits(world, {offer}, 0, now);
  if (ordered.state == ServerEditsResult::State::ordered)
    return AddedAt{world.materials_seq, first};
  if (ordered.state == ServerEditsResult::State::busy)
    return refusal(std::string(ordered.reason) + ": try again later");
  return refusal("the world takes no changes any more");
}

void apply_materials(WorldState& world, const std::vector<EditRecord>& records) {
  bool has_changed = false;
  for (const EditRecord& record : records) {
    const AddedMaterials* added = added_materials_of(record.edit);
    if (added == nullptr) continue;
    const auto appended = world.config.materials.append(added->first, added->rows);
    RUNSTONE_ASSERT(appended.has_value());
    world.materials_seq = record.version.seq;
    has_changed = true;
  }
  if (!has_changed) return;
  world.authority.set_material_count(world.config.materials.size());
  for (const SessionId session : world.open_sessions()) send_materials(world, session);
}

void send_materials(WorldState& world, SessionId session) {
  WorldSession* mine = world.find(session);
  const MaterialTable& table = world.config.materials;
  if (mine->is_relayed || mine->materials_known == table.size()) return;
  if ((mine->features & kFeatureMaterials) == 0) {
    return close_session(world, session, GoodbyeReason::closing,
                         "the world has new materials: connect again");
  }
  while (mine->materials_known < table.size()) {
    const MaterialsAdded message = rows_from(table, mine->materials_known);
    if (!send_or_close(world, session, message)) return;
    mine->materials_known += message.rows.size();
  }
}

}  // namespace runstone
