// frame_bytes(): the size of a frame, by its header (frame.hpp has the layout). Programs that pass
// on whole frames use it. Pure.
#pragma once
#include <cstddef>

#include "common/core/bytes.hpp"
#include "protocol/limits.hpp"

namespace runstone {

/// Returns the size of the frame that begins with this header, header and body. The size may exceed
/// the limits of a frame. Requires kFrameHeaderBytes bytes.
inline std::size_t frame_bytes(ByteView header) {
  return kFrameHeaderBytes + (std::size_t{header[0]} | std::size_t{header[1]} << 8);
}

}  // namespace runstone
