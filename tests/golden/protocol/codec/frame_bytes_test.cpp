#include <catch2/catch.hpp>

#include <string>

#include "protocol/codec/frame.hpp"
#include "protocol/codec/message_table.hpp"
#include "tests/support/core/hex.hpp"
#include "tests/support/core/page_example.hpp"

// The bytes were computed by hand from docs/protocol.md: a change here is a new protocol version.
namespace runstone::test {

TEST_CASE("frame headers are pinned", "[protocol][golden]") {
  FrameWriter writer;
  const auto hex = [](const FrameHeader& header) { return to_hex(ByteView(header)); };
  const std::string first = hex(writer.next(kKindOf<Commit>, 300, false));
  CHECK(first ==
        "2c01"
        "09"
        "00"
        "00000000");
  CHECK(first == page_example("frame-header"));
  CHECK(hex(writer.next(kKindOf<Chunks>, 16384, true)) ==
        "0040"
        "07"
        "01"
        "01000000");
  CHECK(hex(writer.next(kKindOf<ChunksNotModified>, 1, false)) ==
        "0100"
        "1b"
        "00"
        "02000000");
}

TEST_CASE("a stream of two classes is pinned", "[protocol][golden]") {
  const Bytes stream = from_hex(
      "0200 02 01 00000000 6162"  // Welcome "ab", more follows
      "0100 0b 00 01000000 7a"    // Durable "z" overtakes
      "0100 02 00 02000000 63");  // Welcome "c"
  FrameReader reader(Sender::server);
  std::string read;
  const auto fed = reader.feed(stream, [&read](MessageKind kind, ByteView body) -> Result<void> {
    read += std::string(info_of(kind).name) + ":" + std::string(body.begin(), body.end()) + " ";
    return {};
  });
  REQUIRE(fed.has_value());
  CHECK(read == "Durable:z Welcome:abc ");
}

}  // namespace runstone::test
