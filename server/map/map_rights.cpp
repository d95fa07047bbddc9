#include "server/map/map_rights.hpp"

namespace runstone {

MapRights rights_of_strangers(const RightsState& rights, TimeUs now_us) {
  constexpr PublicKey kNoKey{};
  MapRights out;
  if (rights.password().value) {
    out.why = "players join this world with a password, so its map is not public";
    return out;
  }
  out.may_see = rights.decide(kNoKey, Right::see, now_us).is_allowed;
  out.may_look_back = out.may_see && rights.decide(kNoKey, Right::look_back, now_us).is_allowed;
  if (!out.may_see) out.why = "this world is for invited players, so its map is not public";
  return out;
}

StoreResult<MapRights> read_map_rights(LogReader& reader, TimeUs now_us) {
  RightsState state;
  const auto read = reader.read_rights([&](const EditRecord& record) {
    if (const RightsChange* change = rights_change_of(record.edit))
      state.apply(*change, {record.version.seq, record.op.author, record.time_us});
    return true;
  });
  if (!read) return failure(read.error());
  return rights_of_strangers(state, now_us);
}

}  // namespace runstone
