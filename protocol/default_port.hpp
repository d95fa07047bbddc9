// The TCP port of a server where the command line names none.
#pragma once
#include <cstdint>

namespace runstone {

inline constexpr std::uint16_t kDefaultPort = 4747;

}  // namespace runstone
