// Frames of any length, for tests of what passes frames on without reading them.
#pragma once
#include <cstddef>

#include "protocol/codec/frame.hpp"

namespace runstone::test {

/// Returns the next frame of a writer, with a body of so many bytes.
inline Bytes frame_of(FrameWriter& writer, std::size_t body_bytes) {
  const FrameHeader header = writer.next(0, body_bytes, false);
  Bytes out(header.begin(), header.end());
  out.resize(kFrameHeaderBytes + body_bytes, static_cast<std::uint8_t>(body_bytes));
  return out;
}

}  // namespace runstone::test
