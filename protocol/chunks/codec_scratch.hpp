// Scratch of the chunk codec, which lives per thread between chunks. Internal to the codec.
#pragma once
#include <cstddef>

#include "common/core/bytes.hpp"

namespace runstone {

/// Frees the buffer if a huge chunk made it grow beyond 1 MiB.
inline void keep_small(Bytes& bytes) {
  constexpr std::size_t kBytesKept = 1 << 20;
  if (bytes.capacity() > kBytesKept) Bytes().swap(bytes);
}

}  // namespace runstone
