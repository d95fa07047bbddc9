// Bytes as text: two lower-case hex digits for each byte.
#pragma once
#include <string>

#include "common/core/bytes.hpp"

namespace runstone {

std::string to_hex(ByteView bytes);

}  // namespace runstone
