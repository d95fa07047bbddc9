// Rights: what the rights of the world allow its players. The server's setting `operators` names
// keys that have every right, whatever the log says. Changes are made in server/world/commit.
// Thread: the world strand.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/rights/change_rules.hpp"
#include "common/rights/rights_state.hpp"
#include "server/limits/recent_refusals.hpp"
#include "server/world/environment/world_config.hpp"
#include "server/world/order/order.hpp"
#include "server/world/sessions/sessions.hpp"

namespace runstone {

class Rights {
 public:
  Rights(const WorldConfig& config, const WorldStart& start, const Order& order,
         Sessions& sessions);

  const RightsState& state() const { return state_; }
  /// Returns the time by which restrictions end (UTC): that of the log (LogClock::time()).
  TimeUs time() const { return order_.authority().log_clock().time(); }
  /// Returns the sequence of the last change of rights in this run, or 0.
  Sequence newest() const { return newest_; }
  /// Returns a number that rises whenever something may have changed for players.
  std::uint64_t revision() const { return revision_; }
  /// Reports that the settings have changed.
  void settings_changed() { ++revision_; }

  bool is_operator(const PublicKey& key) const { return config_.operators.contains(key); }
  /// Returns the player as the one who makes a change.
  RightsActor actor_of(const PublicKey& key) const { return {key, is_operator(key)}; }
  /// Decides about a right without a place.
  RightsDecision decide(const PublicKey& key, Right right) const;

  // Each returns the reason, as a sentence, or nullopt if the player may do it.
  /// Returns why the player may not edit at all, if a restriction forbids it.
  std::optional<std::string> freeze_text(const PublicKey& key) const;
  /// Returns why the player may not write to the others: a mute with its reason and end, or the
  /// role.
  std::optional<std::string> chat_refusal(const PublicKey& key) const;
  /// Returns why nobody with this key may join from this address, for goodbye not_admitted.
  /// Administrators may join from everywhere, so that no ban of addresses locks them out.
  std::optional<std::string> address_refusal(const PublicKey& key, AddressBlock address) const;
  /// Returns address_refusal(), or that the player is banned, or nullopt.
  std::optional<std::string> ban_refusal(const PublicKey& key, AddressBlock address) const;
  /// Returns why the player may not join from this address: ban_refusal(), or the role may not see
  /// the world.
  std::optional<std::string> join_refusal(const PublicKey& key, AddressBlock address) const;
  /// Returns why the player may not make the edit, for reject not_permitted. Requires a valid edit.
  /// Cost: RightsState::decide_edit().
  std::optional<std::string> edit_refusal(const PublicKey& key, const EditDescriptor& edit) const;
  /// Returns why the author may not make the edit. The server (0) may make every edit.
  std::optional<std::string> edit_refusal(AuthorId author, const EditDescriptor& edit) const;
  /// Returns why the change may not be made: why_refused(), no player acts on an operator, and no
  /// player but an administrator bans an address from which somebody is here on whom that player
  /// may not act.
  std::optional<std::string> change_refusal(const RightsChange& change,
                                            const RightsActor& actor) const;

  /// Takes over the changes of rights among these records, which were ordered just now. Returns the
  /// ground that they affect, or nullopt if there are none.
  std::optional<std::vector<VoxelBox>> apply(const std::vector<EditRecord>& records);
  /// Closes the sessions that may not stay.
  void close_refused();
  /// Advances the time to the time of the log. Returns the grants that have ended since the last
  /// call. The first call returns none. Cost: O(timed grants).
  std::vector<GrantRole> end_grants();

  /// Notes that a player was refused something, for moderators.
  void note_refusal(const PublicKey& key, const std::string& what, TimeUs utc_us) {
    refusals_.add(key, what, utc_us);
  }
  /// Returns what players were refused lately, the newest last.
  std::vector<RefusalRow> refusals() const { return refusals_.rows(); }

 private:
  std::string refusal_text(const PublicKey& key, const RightsDecision& no) const;

  const WorldConfig& config_;
  const Order& order_;
  Sessions& sessions_;
  RightsState state_;
  Sequence newest_ = 0;
  std::uint64_t revision_ = 0;
  std::optional<TimeUs> grants_ended_us_;  // end_grants() has returned those up to this time
  RecentRefusals refusals_;
};

}  // namespace runstone
