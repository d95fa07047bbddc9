#include "protocol/codec/body_reader.hpp"

namespace runstone {

Result<Message> BodyReader::read(const wire::Servers& t) const {
  const auto count = count_of(t.servers(), kServersMax);
  if (!count) return bad("servers has more than 64 entries");
  Servers m;
  m.servers.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    const wire::ServerEntry& from = *t.servers()->Get(i);
    ServerEntry& to = m.servers[i];
    if (!take_text(from.address(), 1, kServerAddressBytesMax, to.address) ||
        !is_player_address(to.address))
      return bad("servers: an address is not HOST:PORT");
    if (!take_text(from.page(), 0, kServerAddressBytesMax, to.page) || !is_page_address(to.page))
      return bad("servers: not the address of a page");
    to.players = from.players();
    if (i > 0 && to.address <= m.servers[i - 1].address)
      return bad("servers: addresses do not ascend");
  }
  m.here = t.here();
  if (m.here > *count) return bad("servers.here names no entry");
  return m;
}

}  // namespace runstone
