#include "common/os/host_port.hpp"

#include <charconv>

namespace runstone {

std::string parse_host_port(const std::string& text, std::string& host, std::uint16_t& port) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return "expected HOST:PORT";
  unsigned number = 0;
  const char* const end = text.data() + text.size();
  const auto [behind, error] = std::from_chars(text.data() + colon + 1, end, number);
  if (error != std::errc() || behind != end || number == 0 || number > 65535) {
    return "the port is not a number of 1 to 65535";
  }
  host = text.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  port = static_cast<std::uint16_t>(number);
  return {};
}

}  // namespace runstone
