// Key pairs that are the same in every run.
#pragma once
#include <cstdint>

#include "protocol/codec/handshake.hpp"

namespace runstone::test {

inline KeyPair keys(std::uint8_t seed) {
  KeySeed bytes{};
  bytes[0] = seed;
  return key_pair_of(bytes);
}

}  // namespace runstone::test
