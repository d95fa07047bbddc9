// DurableState: how far a world was durable.
#pragma once
#include <compare>

#include "common/core/ids.hpp"

namespace runstone {

/// The numbers of a world that never go back. They are compared in this order: a newer epoch wins,
/// also if its log is shorter because an operator accepted a loss.
struct DurableState {
  Epoch epoch = 0;          // of the last start
  Sequence seq = 0;         // of the last edit
  AuthorId author_max = 0;  // the highest author number that is stored
  friend auto operator<=>(const DurableState&, const DurableState&) = default;
};

}  // namespace runstone
