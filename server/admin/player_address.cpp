#include "server/admin/player_address.hpp"

#include "common/os/host_port.hpp"
#include "protocol/codec/server_list.hpp"
#include "server/admin/peer_address.hpp"

namespace runstone {

std::string player_address_of(const ServerConfig& config, std::uint16_t port) {
  const auto set = parse_host_port(config.player_address, port);
  std::string address = set ? to_string(*set) : peer_address_of(config, port);
  return is_player_address(address) ? address : std::string();
}

}  // namespace runstone
