#include "server/net/peer_text.hpp"

#include <algorithm>
#include <asio/ip/address_v4.hpp>
#include <asio/ip/address_v6.hpp>

namespace runstone {
namespace {

constexpr std::uint32_t kMaskV4 = 0xffffff00U;
constexpr std::ptrdiff_t kPrefixBytesV6 = 6;

asio::ip::address plain(const asio::ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
}

}  // namespace

std::string peer_text(const asio::ip::tcp::endpoint& peer, AddressForm form) {
  const asio::ip::address address = plain(peer.address());
  switch (form) {
    case AddressForm::full: {
      const std::string text = address.to_string();
      return (address.is_v6() ? "[" + text + "]" : text) + ":" + std::to_string(peer.port());
    }
    case AddressForm::prefix: {
      if (address.is_v4()) {
        return asio::ip::address_v4(address.to_v4().to_uint() & kMaskV4).to_string() + "/24";
      }
      auto bytes = address.to_v6().to_bytes();
      std::fill(bytes.begin() + kPrefixBytesV6, bytes.end(), std::uint8_t{0});
      return asio::ip::address_v6(bytes).to_string() + "/48";
    }
    case AddressForm::none:
      break;
  }
  return "-";
}

}  // namespace runstone
