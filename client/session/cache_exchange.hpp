// exchange_lookups: passes lookups and their results between a session and its cache. The desktop
// client and the browser client have different caches with the same functions.
#pragma once
#include <cstddef>
#include <utility>

#include "client/session/client_session.hpp"

namespace runstone {

/// `cache` is a CacheThread or a WebCache. A lookup finds chunks that take `room_bytes` at most.
/// Call it every turn.
template <typename Cache>
void exchange_lookups(ClientSession& session, Cache& cache, std::size_t room_bytes, TimeUs now_us) {
  for (auto& found : cache.drain_results()) session.receive_cache_result(std::move(found), now_us);
  while (auto lookup = session.take_cache_lookup()) {
    lookup->bytes_max = room_bytes;
    cache.look_up(*std::move(lookup));
  }
}

}  // namespace runstone
