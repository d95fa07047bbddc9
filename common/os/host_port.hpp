// HostPort: the address of a server as people type it on a command line or in a configuration.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

struct HostPort {
  std::string host;  // a name, an IPv4 address, or an IPv6 address without brackets
  std::uint16_t port = 0;
  friend bool operator==(const HostPort&, const HostPort&) = default;
};

/// Returns "HOST:PORT", or "[V6]:PORT" if the host has a colon.
std::string to_string(const HostPort& address);

/// Reads the address of a server to connect to, in one of these forms, where V6 is an IPv6 address:
///   HOST   HOST:PORT   V6   [V6]   [V6]:PORT
/// An address without a port gets `default_port`. A text with two or more colons and no bracket is
/// a V6. The host is not resolved or checked any further. Fails with one line of text if the form
/// is wrong or the port is not a number from 1 to 65535.
Result<HostPort, std::string> parse_host_port(std::string_view text, std::uint16_t default_port);

/// Reads one such address or several, separated by commas.
Result<std::vector<HostPort>, std::string> parse_host_ports(std::string_view text,
                                                            std::uint16_t default_port);

/// Reads the address that a server listens on: a form of parse_host_port(), or ":PORT" for every
/// IPv4 address of the machine. Port 0 is allowed: it takes a free port.
Result<HostPort, std::string> parse_listen_address(std::string_view text,
                                                   std::uint16_t default_port);

}  // namespace runstone
