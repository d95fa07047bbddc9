// Rights handlers: what the rights of the world allow its sessions, and changes of rights. The
// server's setting `operators` names keys that have every right, whatever the log says.
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "common/rights/change_rules.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// Returns the time by which restrictions end: that of the log, which a wrong clock does not set
/// back.
TimeUs rights_time(const WorldState& world);
/// Returns the player as the one who makes a change.
RightsActor actor_of(const WorldState& world, const PublicKey& key);

/// Decides about a right without a place.
RightsDecision decide(const WorldState& world, const PublicKey& key, Right right);
/// Returns why the player may not edit at all, if a restriction forbids it, or nullopt.
std::optional<std::string> freeze_text(const WorldState& world, const PublicKey& key);
/// Returns why the player may not write to the others, or nullopt: a mute with its reason and end, or
/// the role.
std::optional<std::string> chat_refusal(const WorldState& world, const PublicKey& key);
/// Returns why nobody with this key may join from this address, for goodbye not_admitted, or nullopt.
/// Administrators may join from everywhere, so that no ban of addresses locks them out.
std::optional<std::string> address_refusal(const WorldState& world, const PublicKey& key,
                                           AddressBlock address);
/// Returns the same, or that the player is banned.
std::optional<std::string> ban_refusal(const WorldState& world, const PublicKey& key,
                                       AddressBlock address);
/// Returns the same, or that the player's role may not see the world.
std::optional<std::string> join_refusal(const WorldState& world, const PublicKey& key,
                                        AddressBlock address);
/// Returns why the player may not make the edit, for reject not_permitted, or nullopt. Requires a
/// valid edit. Cost: RightsState::decide_edit().
std::optional<std::string> edit_refusal(const WorldState& world, const PublicKey& key,
                                        const EditDescriptor& edit);

/// Returns why the change may not be made, or nullopt: why_refused(), no player acts on an operator,
/// and no player but an administrator bans an address from which somebody is here on whom that player
/// may not act.
std::optional<std::string> change_refusal(const WorldState& world, const RightsActor& actor,
                                          const RightsChange& change);
/// Orders a change of rights as a record of the log, made by the author (0: the console), who pays
/// for it as for an edit. Returns its sequence, or why it was refused, as a sentence.
Result<Sequence, std::string> change_rights(WorldState& world, const RightsChange& change,
                                            const RightsActor& actor, AuthorId author,
                                            const Clocks& now);
/// Accepts the invite of a ticket for an authenticated player who has no granted role. Returns why
/// nothing was granted, as a sentence, or nullopt. The session may be closed on return, if the role
/// may not see the world.
std::optional<std::string> accept_invite(WorldState& world, SessionId session,
                                         const std::string& ticket, const Clocks& now);
/// Does the same with the key of the world's password. A wrong one is charged to the player's
/// address.
std::optional<std::string> accept_password(WorldState& world, SessionId session,
                                           const PasswordKey& key, const Clocks& now);
/// Takes over the changes of rights among these records, which were ordered just now, closes the
/// sessions that may not stay, and marks the others for what changes for them.
void apply_rights(WorldState& world, const std::vector<EditRecord>& records);

/// Closes the sessions of a player or of a range of addresses. Returns their number.
std::size_t kick(WorldState& world, const RestrictionSubject& who, const std::string& reason);

}  // namespace runstone
