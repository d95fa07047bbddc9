// ChannelBinding: identifies an encrypted connection. Both ends of it have the same 32 bytes, and
// nobody can make another connection that has them. So a signature over them cannot be relayed to
// another connection (RFC 5056, RFC 9266).
#pragma once
#include <array>
#include <cstdint>

namespace runstone {

using ChannelBinding = std::array<std::uint8_t, 32>;

}  // namespace runstone
