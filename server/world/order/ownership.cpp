#include "server/world/order/ownership.hpp"

#include "common/core/assert.hpp"

namespace runstone {

using State = OwnershipState;

bool Ownership::try_to_move(State from, State to) {
  return state_.compare_exchange_strong(from, to);
}
void Ownership::move(State from, State to) {
  const bool has_moved = try_to_move(from, to);
  RUNSTONE_ASSERT(has_moved);
}

void Ownership::begin_following() { move(State::owning, State::following); }
void Ownership::begin_handover() { move(State::owning, State::handing_over); }
void Ownership::end_handover() { move(State::handing_over, State::following); }
void Ownership::begin_takeover() {
  move(is(State::forked) ? State::forked : State::following, State::taking_over);
}
void Ownership::end_takeover() { move(State::taking_over, State::owning); }

void Ownership::lose_log() {
  if (!try_to_move(State::owning, State::log_lost))
    try_to_move(State::handing_over, State::handover_failed);
}
void Ownership::find_fork() {
  if (is(State::forked)) return;
  move(is(State::taking_over) ? State::taking_over : State::following, State::forked);
}
void Ownership::fail_takeover() { move(State::taking_over, State::takeover_failed); }

}  // namespace runstone
