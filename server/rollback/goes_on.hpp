// GoesOn: whether a long read is still wanted. Asked for every record, from the thread that reads.
#pragma once
#include <functional>

#include "server/store/store_error.hpp"
#include "server/store/world_info.hpp"

namespace runstone {

/// Empty: always.
using GoesOn = std::function<bool()>;

/// What a read ends with that is not wanted any more.
inline Unexpected<StoreError> cancelled(const WorldInfo& reader) {
  return {{StoreError::Kind::cancelled, reader.file(), "edit_log", "cancelled"}};
}

}  // namespace runstone
