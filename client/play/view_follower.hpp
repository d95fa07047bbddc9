// ViewFollower: keeps the session's view around the player and knows whether all of it has arrived.
// One thread.
#pragma once
#include <optional>

#include "client/play/player.hpp"
#include "client/schedule/memory_budget.hpp"
#include "client/schedule/view_pace.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

class ViewFollower {
 public:
  /// Session and player must outlive the follower.
  ViewFollower(ClientSession& session, const Player& player, ViewRadii radii,
               std::uint8_t far_levels = 0)
      : session_(session), player_(player), radii_(radii), far_levels_(far_levels) {}

  /// Gives the session the player's pose and, if ViewPace allows it, a view around the player.
  /// Returns true if the view covers other chunks than before.
  bool follow(TimeUs now_us);
  /// Gives the session a view with other radii, at once.
  void set_radii(ViewRadii radii);
  ViewRadii radii() const { return radii_; }
  /// Gives the session a view with another number of levels of tiles, at once. Levels beyond the
  /// reach of the picture are left out (useful_levels()).
  void set_far_levels(std::uint8_t levels);
  /// Returns true if the view is centred on the player's chunk.
  bool has_followed() const;
  /// Returns true if the view is centred on the player's chunk and all of its chunks are here.
  bool is_complete() const { return has_followed() && session_.loaded(); }
  /// Updates complete_since_us(). Call it once per turn of the main loop.
  void update_completeness(TimeUs now_us);
  /// Returns the time of the first update since which every update has found the view complete, or
  /// nullopt if the last update did not.
  std::optional<TimeUs> complete_since_us() const { return complete_since_us_; }

 private:
  /// Requests the view with the radii of this follower.
  void set_view(View view);

  ClientSession& session_;
  const Player& player_;
  ViewRadii radii_;
  std::uint8_t far_levels_;
  ViewPace pace_;
  std::optional<TimeUs> complete_since_us_;
};

}  // namespace runstone
