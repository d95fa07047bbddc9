// MapRights: what strangers may see of a world. A visitor of the map is a player without a key, so
// the default role decides, and a password keeps all of them out.
#pragma once
#include <string>

#include "common/rights/rights_state.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

struct MapRights {
  bool may_see = false;        // the world as it is
  bool may_look_back = false;  // the world as it was, and who built it
  std::string why;             // may_see is false: the reason, as one sentence
};

/// Returns what strangers may see by the records of the log.
MapRights rights_of_strangers(const RightsState& rights, TimeUs now_us);
/// Reads the records of a world. Blocks on the disk. Cost: O(changes of rights).
StoreResult<MapRights> read_map_rights(LogReader& reader, TimeUs now_us);

}  // namespace runstone
