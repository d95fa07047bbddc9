// ProxyHeader: the PROXY protocol, version 2, with which a gateway passes on the address of the
// client that it speaks for (https://www.haproxy.org/download/2.8/doc/proxy-protocol.txt, 2.2). The
// header stands once, before the first byte of the connection:
//   12 bytes of signature | u8 version 2 and command | u8 address family and protocol |
//   u16 bytes that follow, network order | addresses and ports | TLVs
// Both sides of this project are strict: the header names TCP over IPv4 or IPv6, or is LOCAL, and
// its TLVs fill it exactly. TLVs are skipped, because nothing here depends on one.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Bytes up to the length field, which every header has.
inline constexpr std::size_t kProxyPrefixBytes = 16;
/// Bytes of a whole header. The specification asks senders to stay within one TCP segment of 536.
inline constexpr std::size_t kProxyHeaderBytesMax = 536;

/// An address and a port of TCP.
struct PeerEndpoint {
  std::array<std::uint8_t, 16> address{};  // IPv6 in network order; IPv4 as ::ffff:a.b.c.d
  std::uint16_t port = 0;
  friend bool operator==(const PeerEndpoint&, const PeerEndpoint&) = default;
};
/// Returns the endpoint of an IPv4 address, in host order.
PeerEndpoint peer_endpoint_v4(std::uint32_t address, std::uint16_t port);

struct ProxyHeader {
  std::optional<PeerEndpoint> client;  // nullopt: LOCAL, a connection of the gateway itself
};

/// Returns the size of the whole header. Requires kProxyPrefixBytes bytes, its first ones. Fails if
/// they do not begin a header of this version and of at most kProxyHeaderBytesMax bytes.
Result<std::size_t> proxy_header_bytes(ByteView prefix);
/// Reads a header. Fails unless the bytes are exactly one. Offsets of errors count its bytes.
Result<ProxyHeader> read_proxy_header(ByteView header);
/// Returns the header of a client's connection to `gateway`, without TLVs. It is of IPv4 if both
/// addresses are.
Bytes write_proxy_header(const PeerEndpoint& client, const PeerEndpoint& gateway);

}  // namespace runstone
