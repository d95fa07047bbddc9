#include "server/admin/player_address.hpp"

#include "common/os/host_port.hpp"

namespace runstone {

std::string player_address_of(const ServerConfig& config, std::uint16_t port) {
  const auto address = parse_host_port(config.player_address, port);
  return address ? to_string(*address) : std::string();
}

}  // namespace runstone
