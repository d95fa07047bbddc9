// Invite token: the text that a player needs to accept an invite. It is the URL-safe base64 form of
// the invite's number and the server's signature over world and number, so nobody else can make
// one, and the server keeps nothing for it but the record of the invite.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "common/rights/invite.hpp"
#include "protocol/codec/handshake.hpp"

namespace runstone {

/// The size of every token: 8 + 64 bytes in base64.
inline constexpr std::size_t kInviteTokenBytes = 96;

/// Cost: one signature.
std::string invite_token(InviteId invite, const WorldId& world, const KeyPair& server);

/// Returns the number of the invite, or nullopt if the token is not one of this world and server.
/// Cost: one signature check, about 0.1 ms; nothing for a text of another size.
std::optional<InviteId> invite_of(std::string_view token, const WorldId& world,
                                  const PublicKey& server);

}  // namespace runstone
