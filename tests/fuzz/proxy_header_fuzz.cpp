// The target reads any bytes as a PROXY header. A header that is accepted has the size that its
// prefix names, and its client survives being written and read again.
#include <cstdint>

#include "common/core/assert.hpp"
#include "protocol/codec/proxy_header.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  const ByteView bytes(data, size);
  const auto read = read_proxy_header(bytes);
  if (!read) return 0;
  RUNSTONE_ASSERT(size >= kProxyPrefixBytes && size <= kProxyHeaderBytesMax);
  const auto named = proxy_header_bytes(bytes.first(kProxyPrefixBytes));
  RUNSTONE_ASSERT(named.has_value() && *named == size);
  if (!read->client) return 0;
  const auto again = read_proxy_header(write_proxy_header(*read->client, PeerEndpoint{}));
  RUNSTONE_ASSERT(again.has_value() && again->client == read->client);
  return 0;
}
