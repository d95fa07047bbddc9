#include "server/world/cluster/owner_link.hpp"

#include <array>
#include <cstring>

namespace runstone {
namespace {

constexpr TimeUs kPingIntervalUs = 1'000'000;
constexpr TimeUs kOwnerSilentUsMax = 5'000'000;

}  // namespace

std::optional<TimeUs> OwnerLink::heard_us() const {
  const bool is_connected = stage_ == Stage::reading || stage_ == Stage::live;
  return is_connected ? std::optional(heard_us_) : std::nullopt;
}

bool OwnerLink::connected(const std::optional<ChannelBinding>& binding, const Clocks& now) {
  stage_ = Stage::greeting;
  binding_ = binding;
  heard_us_ = pinged_us_ = now.steady_us;
  const ClientInstance earlier = hello_.instance;
  hello_ = {};
  hello_.key = config_.server_keys.public_key;
  hello_.name = "server";
  hello_.features = kFeaturesOfServers | kFeatureServerList;
  // Each connection of this start sends one number, so that the owner knows which one it replaces.
  hello_.instance = earlier;
  if (earlier == 0) {
    std::array<std::uint8_t, sizeof hello_.instance> instance{};
    random_(instance);
    std::memcpy(&hello_.instance, instance.data(), sizeof hello_.instance);
  }
  random_(hello_.nonce);
  return send(hello_);
}

Result<void, std::string> OwnerLink::on_welcome(const Welcome& welcome) {
  const PublicKey& key = config_.server_keys.public_key;
  const Bytes transcript = server_transcript(hello_, welcome, binding_);
  if (welcome.world_id != config_.world_id || welcome.server_key != key ||
      !verify(key, transcript, welcome.signature))
    return failure("what answers there is no server of this world");
  if ((welcome.features & kFeatureServers) == 0)
    return failure("the server there does not let others follow");
  if (welcome.epoch < order_.last_record().epoch) return failure(kTakenOver);
  stage_ = Stage::authenticating;
  owner_epoch_ = welcome.epoch;
  const Bytes own = client_transcript(hello_, welcome, binding_);
  if (!send(ClientAuth{sign(config_.server_keys, own), "", std::nullopt}))
    return failure(kOwnerReadsTooSlowly);
  return {};
}

bool OwnerLink::ask_for_log() {
  stage_ = Stage::asking;
  return send(
      FollowRequest{{order_.epoch(), order_.head()}, config_.player_address, config_.page_address});
}

Result<void, std::string> OwnerLink::tick(const Clocks& now) {
  if (stage_ == Stage::none) return {};
  if (now.steady_us - heard_us_ >= kOwnerSilentUsMax)
    return failure("the owner has sent nothing for too long");
  if (!heard_us() || now.steady_us - pinged_us_ < kPingIntervalUs) return {};
  pinged_us_ = now.steady_us;
  if (!send(Ping{now.steady_us})) return failure(kOwnerReadsTooSlowly);
  return {};
}

}  // namespace runstone
