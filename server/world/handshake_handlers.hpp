// Handshake handlers: hello is answered with welcome, client auth with session accepted. The server
// sends nothing of the world before session accepted.
#pragma once
#include "server/world/world_state.hpp"

namespace runstone {

/// Sends a signed welcome, or closes the session: wrong_protocol (the text names both versions) or
/// server_full, name_refused or not_admitted.
void on_hello(WorldState& world, SessionId session, const Hello& hello);
/// Opens the session, at once or when the claim of its name is on disk, or closes it:
/// not_authenticated, server_full, name_refused or not_admitted. Closes an older session of
/// the same key and client instance (already_connected). The signature shows that both are the same
/// client, and the older connection is usually dead without a sign of it.
void on_client_auth(WorldState& world, SessionId session, const ClientAuth& auth,
                    const Clocks& now);
/// Handles the session of a player at another server, which has authenticated the player: opens it as
/// on_client_auth() does, or closes it. A session of a player whom an earlier owner let in goes on.
void join_relayed(WorldState& world, SessionId session, const RelayOpen& open, const Clocks& now);
/// Opens an authenticated session whose player the owner of the world has let in.
void open_let_in(WorldState& world, SessionId session, const SessionAccepted& accepted,
                 const Clocks& now);
/// Lets those in whom no owner has answered, because this server has become the owner.
void let_waiting_in(WorldState& world, const Clocks& now);
/// Sends the sealed key of a slot and removes it, or closes the session: not_admitted, or flooding
/// after too many requests for empty slots. Whoever has the code may take the key, so the player needs
/// no rights. The session ends in any case.
void on_key_request(WorldState& world, SessionId session, const KeyRequest& request,
                    const Clocks& now);
/// Keeps a sealed key of a player who may join, or answers why not. The session ends in any case, and
/// closes with not_authenticated or not_admitted if the player may not join.
void on_key_deposit(WorldState& world, SessionId session, const KeyDeposit& deposit,
                    const Clocks& now);
/// Opens the sessions that wait for nothing any more.
void open_authenticated(WorldState& world, const Clocks& now);

}  // namespace runstone
