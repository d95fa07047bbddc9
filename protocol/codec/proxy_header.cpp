#include "protocol/codec/proxy_header.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

constexpr std::array<std::uint8_t, 12> kProxySignature = {0x0d, 0x0a, 0x0d, 0x0a, 0x00, 0x0d,
                                                          0x0a, 0x51, 0x55, 0x49, 0x54, 0x0a};
constexpr std::uint8_t kVersion2 = 0x20;
constexpr std::uint8_t kLocalCommand = 0, kProxyCommand = 1;
constexpr std::uint8_t kTcpOverV4 = 0x11, kTcpOverV6 = 0x21;
// The places of the fields behind the signature.
constexpr std::size_t kCommandAt = 12, kFamilyAt = 13, kLengthAt = 14;
constexpr std::size_t kPortsBytes = 4, kTlvHeaderBytes = 3;
constexpr std::array<std::uint8_t, 12> kMappedPrefix = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

std::uint16_t network_u16(ByteView in, std::size_t at) {
  return static_cast<std::uint16_t>(in[at] << 8 | in[at + 1]);
}

bool is_v4(const PeerEndpoint& peer) {
  return std::equal(kMappedPrefix.begin(), kMappedPrefix.end(), peer.address.begin());
}

/// Fails unless the bytes from `at` to the end are whole TLVs.
Result<void> skip_tlvs(ByteView header, std::size_t at) {
  while (at < header.size()) {
    if (header.size() - at < kTlvHeaderBytes)
      return fail(ErrorCode::truncated, "a TLV of the PROXY header is cut", at);
    const std::size_t bytes = network_u16(header, at + 1);
    if (header.size() - at - kTlvHeaderBytes < bytes)
      return fail(ErrorCode::truncated, "a TLV of the PROXY header is cut", at);
    at += kTlvHeaderBytes + bytes;
  }
  return {};
}

}  // namespace

PeerEndpoint peer_endpoint_v4(std::uint32_t address, std::uint16_t port) {
  PeerEndpoint out;
  std::copy(kMappedPrefix.begin(), kMappedPrefix.end(), out.address.begin());
  for (std::size_t i = 0; i < 4; ++i)
    out.address[kMappedPrefix.size() + i] = static_cast<std::uint8_t>(address >> (24 - 8 * i));
  out.port = port;
  return out;
}

Result<std::size_t> proxy_header_bytes(ByteView prefix) {
  RUNSTONE_ASSERT(prefix.size() == kProxyPrefixBytes);
  if (!std::equal(kProxySignature.begin(), kProxySignature.end(), prefix.begin()))
    return fail(ErrorCode::bad_value, "no signature of the PROXY protocol, version 2");
  const std::uint8_t command = prefix[kCommandAt];
  if ((command & 0xf0) != kVersion2)
    return fail(ErrorCode::bad_version, "the PROXY header is not of version 2", kCommandAt);
  if ((command & 0x0f) > kProxyCommand)
    return fail(ErrorCode::unknown_kind, "unknown command of the PROXY header", kCommandAt);
  const std::size_t bytes = kProxyPrefixBytes + network_u16(prefix, kLengthAt);
  if (bytes > kProxyHeaderBytesMax)
    return fail(ErrorCode::limit_exceeded, "the PROXY header has more than 536 bytes", kLengthAt);
  return bytes;
}

Result<ProxyHeader> read_proxy_header(ByteView header) {
  if (header.size() < kProxyPrefixBytes)
    return fail(ErrorCode::truncated, "the PROXY header is cut", header.size());
  const auto bytes = proxy_header_bytes(header.first(kProxyPrefixBytes));
  if (!bytes) return failure(bytes.error());
  if (header.size() < *bytes)
    return fail(ErrorCode::truncated, "the PROXY header is cut", header.size());
  if (header.size() > *bytes)
    return fail(ErrorCode::trailing_bytes, "bytes behind the PROXY header", *bytes);
  // The specification lets a LOCAL header have anything behind its prefix.
  if ((header[kCommandAt] & 0x0f) == kLocalCommand) return ProxyHeader{};
  const std::uint8_t family = header[kFamilyAt];
  if (family != kTcpOverV4 && family != kTcpOverV6)
    return fail(ErrorCode::unknown_kind, "the PROXY header is not of TCP over IPv4 or IPv6",
                kFamilyAt);
  const std::size_t address_bytes = family == kTcpOverV4 ? 4 : 16;
  const std::size_t tlvs_at = kProxyPrefixBytes + 2 * address_bytes + kPortsBytes;
  if (header.size() < tlvs_at)
    return fail(ErrorCode::truncated, "the addresses of the PROXY header are cut", header.size());
  if (const auto skipped = skip_tlvs(header, tlvs_at); !skipped) return failure(skipped.error());
  PeerEndpoint client = peer_endpoint_v4(0, 0);
  const ByteView address = header.subspan(kProxyPrefixBytes, address_bytes);
  std::copy_backward(address.begin(), address.end(), client.address.end());
  client.port = network_u16(header, kProxyPrefixBytes + 2 * address_bytes);
  return ProxyHeader{client};
}

Bytes write_proxy_header(const PeerEndpoint& client, const PeerEndpoint& gateway) {
  const bool v4 = is_v4(client) && is_v4(gateway);
  const std::size_t address_bytes = v4 ? 4 : 16;
  const std::size_t length = 2 * address_bytes + kPortsBytes;
  Bytes out(kProxySignature.begin(), kProxySignature.end());
  out.push_back(kVersion2 | kProxyCommand);
  out.push_back(v4 ? kTcpOverV4 : kTcpOverV6);
  const auto append_u16 = [&](std::size_t value) {
    out.push_back(static_cast<std::uint8_t>(value >> 8));
    out.push_back(static_cast<std::uint8_t>(value));
  };
  append_u16(length);
  for (const PeerEndpoint* each : {&client, &gateway}) {
    out.insert(out.end(), each->address.end() - static_cast<std::ptrdiff_t>(address_bytes),
               each->address.end());
  }
  append_u16(client.port);
  append_u16(gateway.port);
  return out;
}

}  // namespace runstone
