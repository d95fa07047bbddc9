// Handshake steps of a session: hello -> welcome, proof -> ready. Nothing of the world flows before ready.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Answers with a signed welcome, or closes: wrong_protocol (the text names both versions), server_full.
void on_hello(WorldState& world, SessionId session, const Hello& hello);
/// Opens the session, or closes it: not_authenticated. An older session of the same key and client instance
/// is closed (already_connected): the newer one wins, because the older is most often a dead connection that
/// nobody has noticed yet, and the proof shows that both are the same client.
void on_client_auth(WorldState& world, SessionId session, const ClientAuth& proof,
                    const Clocks& now);

}  // namespace runstone
