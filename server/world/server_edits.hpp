// Server edits: edits that the server makes itself: rollback, undo, redo, changes of rights, and new
// materials.
#pragma once
#include <cstddef>
#include <vector>

#include "server/world/clocks.hpp"
#include "server/world/edit_queue.hpp"

namespace runstone {

struct WorldState;

struct ServerEditsResult {
  enum class State {
    ordered,  // all offers
    busy,     // the first `count` offers; a limit rejects the next one for now: try again
    closed,   // none: accepts_edits() returns false
    taken,    // none: a client of the author has used these client sequences
  };
  State state = State::ordered;
  std::size_t count = 0;    // ordered offers, from the first on
  const char* reason = "";  // names the limit if busy
};

/// Orders the offers at once and in order, behind all queued edits, as far as the log has room.
/// Requires that they pass check_server_edit(), that their client sequences ascend, that they
/// have one author and instance, and that their cause is not player. Each offer costs its
/// edit_price(), paid by the key of the author `payer` and the address of the author's first
/// session. An author without a session pays by the key alone. Nobody pays if `payer` is 0.
ServerEditsResult order_server_edits(WorldState& world, const std::vector<EditOffer>& offers,
                                     AuthorId payer, const Clocks& now);

}  // namespace runstone
