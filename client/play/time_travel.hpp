// Time travel: requests the world as it was after an edit of the log, and describes the moment that
// is shown.
#pragma once
#include <optional>
#include <string>

#include "client/session/client_session.hpp"

namespace runstone {

/// Requests the world after the edit `seq`, or the live world if `seq` is the newest edit or later.
/// Does nothing unless open.
void show_after(ClientSession& session, Sequence seq);
/// Requests a moment that is `steps` hundredths of the log later than the one that is shown or
/// requested. The step after the newest edit is the live world.
void step_in_time(ClientSession& session, int steps);
/// Returns the newest edit of the live world, and the edit after which the world is shown; both are
/// kSequenceShownMax at most.
struct ShownSequence {
  Sequence newest = 0, shown = 0;
  friend bool operator==(const ShownSequence&, const ShownSequence&) = default;
};
ShownSequence shown_sequence(const ClientSession& session);
/// Returns the text of a moment of the past, or an empty text for the live world.
std::string moment_text(const std::optional<PastMoment>& past);

}  // namespace runstone
