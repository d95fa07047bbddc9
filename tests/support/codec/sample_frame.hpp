// Frames of any length, for tests of what passes frames on without reading them.
#pragma once
#include <cstddef>

#include "protocol/codec/frame.hpp"

namespace runstone::test {

/// Returns the next frame of a writer, with a body of so many bytes, all of them `fill`.
inline Bytes frame_of(FrameWriter& writer, std::size_t body_bytes, std::uint8_t fill = 1) {
  const FrameHeader header = writer.next(0, body_bytes, false);
  Bytes out(header.begin(), header.end());
  out.resize(kFrameHeaderBytes + body_bytes, fill);
  return out;
}
/// Returns the first frame of a writer.
inline Bytes frame_of(std::size_t body_bytes, std::uint8_t fill = 1) {
  FrameWriter writer;
  return frame_of(writer, body_bytes, fill);
}

}  // namespace runstone::test
