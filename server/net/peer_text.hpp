// The address of a peer as text for log lines.
#pragma once
#include <asio/ip/tcp.hpp>
#include <string>

#include "server/limits/address_form.hpp"

namespace runstone {

/// Returns "203.0.113.7:40312" or "[2001:db8::1]:40312"; as a prefix "203.0.113.0/24" or
/// "2001:db8::/48"; and "-" for AddressForm::none. An IPv4 address within IPv6 is shown as an IPv4
/// address.
std::string peer_text(const asio::ip::tcp::endpoint& peer, AddressForm form);

}  // namespace runstone
