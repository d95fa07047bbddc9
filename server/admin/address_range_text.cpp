#include "server/admin/address_range_text.hpp"

#include <algorithm>
#include <asio/ip/address.hpp>
#include <cstddef>
#include <cstdint>

#include "server/admin/word_reader.hpp"

namespace runstone {
namespace {

constexpr std::uint64_t kIpv4Base = static_cast<std::uint64_t>(address_block_v4(0));
constexpr std::uint8_t kIpv4Bits = 32;  // of a block that holds an IPv4 address, before the address

/// Sets the bits behind the prefix to 0.
AddressRange canonical(AddressBlock block, unsigned bits) {
  const std::uint64_t mask = bits == 0 ? 0 : ~std::uint64_t{0} << (64 - bits);
  return {AddressBlock{static_cast<std::uint64_t>(block) & mask}, static_cast<std::uint8_t>(bits)};
}

}  // namespace

std::optional<Result<ParsedRange, std::string>> parse_address_range(std::string_view text) {
  using Parsed = Result<ParsedRange, std::string>;
  const std::size_t slash = std::min(text.find('/'), text.size());
  asio::error_code error;
  const auto address = asio::ip::make_address(std::string(text.substr(0, slash)), error);
  // An address with a zone ("fe80::1%eth0") is one of this machine's own network.
  if (error || text.find('%') != std::string_view::npos) return std::nullopt;
  const bool is_v4 = address.is_v4() || address.to_v6().is_v4_mapped();
  const AddressBlock block = address.is_v4() ? address_block_v4(address.to_v4().to_uint())
                                             : address_block_v6(address.to_v6().to_bytes());
  if (slash == text.size()) return Parsed(ParsedRange{{block, 64}, !is_v4});
  const unsigned bits_max = is_v4 ? 32 : 64;
  const auto bits = number_of<unsigned>(text.substr(slash + 1));
  if (!bits || *bits > bits_max) {
    return Parsed(failure(is_v4 ? "a number from 0 to 32 comes after the / of IPv4"
                                : "a number from 0 to 64 comes after the / of IPv6: a subscriber "
                                  "has at least a /64"));
  }
  return Parsed(ParsedRange{canonical(block, is_v4 ? *bits + kIpv4Bits : *bits), false});
}

std::string text_of(const AddressRange& range) {
  const auto block = static_cast<std::uint64_t>(range.first);
  if (range.bits >= kIpv4Bits && block >> 32 == kIpv4Base >> 32) {
    const auto address = asio::ip::address_v4(static_cast<std::uint32_t>(block));
    if (range.bits == 64) return address.to_string();
    return address.to_string() + "/" + std::to_string(range.bits - kIpv4Bits);
  }
  asio::ip::address_v6::bytes_type bytes{};
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<unsigned char>(block >> (56 - 8 * i));
  return asio::ip::address_v6(bytes).to_string() + "/" + std::to_string(range.bits);
}

}  // namespace runstone
