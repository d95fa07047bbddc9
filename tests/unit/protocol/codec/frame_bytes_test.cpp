#include "protocol/codec/frame_bytes.hpp"

#include <catch2/catch.hpp>

#include "protocol/codec/frame.hpp"

namespace runstone::test {

TEST_CASE("the header of a frame names its size", "[protocol]") {
  for (const std::size_t body :
       {std::size_t{1}, std::size_t{255}, std::size_t{256}, kFragmentBytesMax}) {
    Bytes frame;
    FrameWriter writer;
    writer.append({0, std::make_shared<const Bytes>(body, std::uint8_t{7})}, frame);
    CHECK(frame_bytes(frame) == frame.size());
  }
}

}  // namespace runstone::test
