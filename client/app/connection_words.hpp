// Words for the player about the connection: while it is made, when it is lost, and when it ends.
#pragma once
#include <string>

#include "client/app/threaded_session.hpp"
#include "client/session/failure_words.hpp"
#include "client/ui/menu_state.hpp"

namespace runstone {

/// Returns the progress of joining. `was_open`: a world was open before, so its chunks arrive.
/// `is_encrypted`: the connection uses TLS.
ConnectingState connecting_state(const ThreadedSession& network, bool was_open, bool is_encrypted,
                                 TimeUs now_us);
/// Returns who else is in the world.
PauseState pause_state(const ClientSession& session);
/// Returns a text about a lost connection, with the number of edits that wait for the server.
/// Returns an empty text while the connection is there.
std::string lost_text(const ThreadedSession& network, TimeUs now_us);
/// Returns the words for a failure, with the number of edits that no server confirmed.
FailureWords failure_words(const ThreadedSession& network);
/// Returns words for a player who leaves while edits wait for a server that is gone, otherwise
/// empty ones.
FailureWords leaving_words(const ThreadedSession& network);

}  // namespace runstone
