#include "server/admin/server_address.hpp"

#include <asio/ip/address.hpp>
#include <asio/ip/host_name.hpp>

#include "common/os/host_port.hpp"

namespace runstone {
namespace {

bool is_every_address(const std::string& host) {
  if (host == "*") return true;
  asio::error_code error;
  const auto address = asio::ip::make_address(host, error);
  return !error && address.is_unspecified();
}

std::string host_of_machine() {
  asio::error_code error;
  const std::string name = asio::ip::host_name(error);
  return error || name.empty() ? "localhost" : name;
}

}  // namespace

std::string player_address_of(const ServerConfig& config, std::uint16_t port) {
  const auto address = parse_host_port(config.player_address, port);
  return address ? to_string(*address) : std::string();
}

std::string peer_address_of(const ServerConfig& config, std::uint16_t port) {
  if (const auto set = parse_host_port(config.peer_address, port)) return to_string(*set);
  const auto listen = parse_listen_address(config.listen, port);
  const bool is_single = listen && !is_every_address(listen->host);
  return to_string(HostPort{is_single ? listen->host : host_of_machine(), port});
}

}  // namespace runstone
