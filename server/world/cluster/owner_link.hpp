// OwnerLink: the connection of a server that follows with the owner of the world: its handshake and
// its pings.
// Thread: the world strand.
#pragma once
#include <optional>
#include <string>

#include "common/core/channel_binding.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/handshake.hpp"
#include "server/world/order/order.hpp"

namespace runstone {

class OwnerLink {
 public:
  enum class Stage {
    none,            // not connected
    greeting,        // Hello was sent
    authenticating,  // ClientAuth was sent
    asking,          // FollowRequest was sent
    reading,         // records that the owner had before are read from the database
    live             // every message is applied as it arrives
  };

  OwnerLink(const WorldConfig& config, WorldEnvironment& environment, const Order& order,
            RandomBytes random)
      : config_(config), environment_(environment), order_(order), random_(std::move(random)) {}

  Stage stage() const { return stage_; }
  void set_stage(Stage stage) { stage_ = stage; }
  bool is_live() const { return stage_ == Stage::live; }
  /// Returns when the owner was heard last, by the steady clock, or nullopt if it is not connected.
  std::optional<TimeUs> heard_us() const;
  /// Returns the epoch of the owner's start. Valid after welcome.
  Epoch owner_epoch() const { return owner_epoch_; }

  /// Forgets the owners before.
  void begin() {
    hello_ = {};
    owner_epoch_ = 0;
  }
  /// Begins the handshake. Returns false if the connection takes nothing.
  bool connected(const std::optional<ChannelBinding>& binding, const Clocks& now);
  void heard(const Clocks& now) { heard_us_ = now.steady_us; }
  /// Answers the welcome. Fails if the sender is not the owner, or reads too slowly.
  Result<void, std::string> on_welcome(const Welcome& welcome);
  /// Asks for the log behind what this server has.
  bool ask_for_log();
  /// Sends a message. Returns false if there is no room, or no connection.
  bool send(const Message& message) { return environment_.send_to_owner(encode_message(message)); }
  /// Sends pings while the owner is connected. Fails if the connection must end.
  Result<void, std::string> tick(const Clocks& now);

 private:
  const WorldConfig& config_;
  WorldEnvironment& environment_;
  const Order& order_;
  RandomBytes random_;
  Stage stage_ = Stage::none;
  Hello hello_;
  std::optional<ChannelBinding> binding_;
  Epoch owner_epoch_ = 0;
  TimeUs heard_us_ = 0, pinged_us_ = 0;  // steady clock: the last message, the last ping
};

/// Why a server leaves an owner that takes no messages.
inline constexpr const char* kOwnerReadsTooSlowly = "the owner reads too slowly";
inline constexpr const char* kTakenOver = "another server has taken the world over";

}  // namespace runstone
