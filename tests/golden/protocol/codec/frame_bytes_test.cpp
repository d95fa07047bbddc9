#include <catch2/catch.hpp>

#include <string>

#include "protocol/codec/frame.hpp"
#include "tests/support/hex.hpp"

// The bytes were computed by hand from docs/protocol.md: a change here is a new protocol version.
namespace runstone::test {

TEST_CASE("frame headers are pinned", "[protocol][golden]") {
  FrameWriter writer;
  const auto hex = [](const FrameHeader& header) { return to_hex(ByteView(header)); };
  CHECK(hex(writer.next(FrameClass::edits, 300, false)) ==
        "2c010000"
        "01"
        "00"
        "0000"
        "00000000");
  CHECK(hex(writer.next(FrameClass::chunks, 16384, true)) ==
        "00400000"
        "02"
        "01"
        "0000"
        "01000000");
  CHECK(hex(writer.next(FrameClass::control, 1, false)) ==
        "01000000"
        "00"
        "00"
        "0000"
        "02000000");
}

TEST_CASE("a stream of two classes is pinned", "[protocol][golden]") {
  const Bytes stream = from_hex(
      "02000000 00 01 0000 00000000 6162"  // control "ab", more follows
      "01000000 01 00 0000 01000000 7a"    // edits "z" overtakes
      "01000000 00 00 0000 02000000 63");  // control "c"
  FrameReader reader(Sender::server);
  std::string read;
  const auto fed = reader.feed(stream, [&read](FrameClass c, ByteView body) -> Result<void> {
    read += std::to_string(static_cast<int>(c)) + ":" + std::string(body.begin(), body.end()) + " ";
    return {};
  });
  REQUIRE(fed.has_value());
  CHECK(read == "1:z 0:abc ");
}

}  // namespace runstone::test
