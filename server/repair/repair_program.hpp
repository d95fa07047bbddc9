// runstone-server repair: makes a sound world of a damaged one. It reads every row that can be
// read, makes everything else anew, says what is gone, and proves the result.
#pragma once
#include <iosfwd>
#include <string>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone {

struct RepairRequest {
  std::string world;      // folder of the damaged world
  std::string to;         // the new folder
  std::string from;       // folder of an older backup; empty: none
  bool in_place = false;  // at the end the two folders exchange their names
  bool progress = false;  // print progress even if standard error is no terminal
};

/// Makes the repaired world in the new folder `to`, and prints what was found, what is gone, and
/// the proof. The damaged world stays as it is; no server may run it. `now_us` is the time in UTC.
/// The error is one line. Fails if
///   - the world cannot be repaired, or another program writes or repairs it. Then `to` does not
///     exist;
///   - the repaired world is not sound. Then it stays in `to`, and the folders are not exchanged.
Result<void, std::string> repair(const RepairRequest& request, TimeUs now_us, std::ostream& out);

}  // namespace runstone
