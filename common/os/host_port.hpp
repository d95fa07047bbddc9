// HostPort: where a server is, as command lines say it.
#pragma once
#include <cstdint>
#include <string>

namespace runstone {

/// "host:port" or "[v6 address]:port". Returns what is wrong with the text, or nothing and sets both.
std::string parse_host_port(const std::string& text, std::string& host, std::uint16_t& port);

}  // namespace runstone
