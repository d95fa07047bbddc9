// Scratch of the chunk codec: it lives per thread between chunks. Internal to the codec.
#pragma once
#include <cstddef>

#include "common/core/bytes.hpp"

namespace runstone {

/// Gives up what one huge chunk made it grow to: that must not be held for ever.
inline void keep_small(Bytes& bytes) {
  constexpr std::size_t kBytesKept = 1 << 20;
  if (bytes.capacity() > kBytesKept) Bytes().swap(bytes);
}

}  // namespace runstone
