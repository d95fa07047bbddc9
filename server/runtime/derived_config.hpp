// The settings of the world strand and of the network, derived from the configuration and from the
// world's meta.
#pragma once
#include "server/admin/server_config.hpp"
#include "server/net/net_session.hpp"
#include "server/store/store.hpp"
#include "server/world/environment/world_config.hpp"

namespace runstone {

/// `port`: the one that the server listens at.
WorldConfig world_config_of(const ServerConfig& config, const WorldMeta& meta, std::uint16_t port);
NetLimits net_limits_of(const ServerConfig& config);

}  // namespace runstone
