// ShouldContinue: a function that a long read calls for every record, on the thread that reads. It
// returns false once the result is no longer wanted.
#pragma once
#include <functional>

#include "server/store/store_error.hpp"
#include "server/store/world_info.hpp"

namespace runstone {

/// An empty function means that the read is always wanted.
using ShouldContinue = std::function<bool()>;

/// Returns the error of a read that is no longer wanted.
inline Unexpected<StoreError> cancelled(const WorldInfo& reader) {
  return {{StoreError::Kind::cancelled, reader.file(), "edit_log", "cancelled"}};
}

}  // namespace runstone
