#include "bench/network/siege_flags.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace runstone::bench {
namespace {

// The server's default settings.
constexpr unsigned kSessionsMax = 256, kSessionsPerAddress = 64, kHandshakesPerAddress = 32,
                   kConnectionsPerSecond = 20;
// The bots of the last window may still be there when those of the next one join.
constexpr unsigned kSpareSeats = 16;

}  // namespace

std::vector<std::string> siege_flags(unsigned bots) {
  const unsigned seats = bots + kSpareSeats;
  std::vector<std::string> out;
  const auto raise = [&](const char* flag, unsigned usual) {
    if (seats > usual) out.insert(out.end(), {flag, fmt::to_string(seats)});
  };
  raise("--sessions-max", kSessionsMax);
  raise("--sessions-per-address", kSessionsPerAddress);
  raise("--handshakes-per-address", kHandshakesPerAddress);
  raise("--connections-per-second", kConnectionsPerSecond);
  return out;
}

}  // namespace runstone::bench
