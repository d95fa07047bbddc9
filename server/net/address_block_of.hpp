// The block of a peer's address.
#pragma once
#include <asio/ip/address.hpp>

#include "common/core/address_block.hpp"

namespace runstone {

inline AddressBlock address_block(const asio::ip::address& address) {
  return address.is_v6() ? address_block_v6(address.to_v6().to_bytes())
                         : address_block_v4(address.to_v4().to_uint());
}

}  // namespace runstone
