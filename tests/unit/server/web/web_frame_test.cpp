#include "server/web/web_frame.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "common/core/hash.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/message_table.hpp"
#include "tests/support/codec/sample_frame.hpp"

using namespace runstone;
using runstone::test::frame_of;

TEST_CASE("a message of a WebSocket is exactly one frame", "[web]") {
  FrameWriter writer;
  for (const std::size_t body : {std::size_t{1}, std::size_t{300}, kFragmentBytesMax}) {
    Bytes frame = frame_of(writer, body);
    CHECK(fault_of_web_message(frame) == nullptr);
    frame.push_back(0);
    CHECK(fault_of_web_message(frame) != nullptr);
    frame.resize(frame.size() - 2);
    CHECK(fault_of_web_message(frame) != nullptr);
  }
  CHECK(fault_of_web_message({}) != nullptr);
  CHECK(fault_of_web_message(Bytes(kFrameHeaderBytes)) != nullptr);  // without a body
  Bytes two = frame_of(writer, 5);
  const Bytes second = frame_of(writer, 6);
  two.insert(two.end(), second.begin(), second.end());
  CHECK(fault_of_web_message(two) != nullptr);
  CHECK(std::string(fault_of_web_message(Bytes(kFrameBytesMax + 1))).find("16392") !=
        std::string::npos);
}

TEST_CASE("a stream is cut into the same frames however it arrives", "[web]") {
  SplitMix64 rng(Catch::rngSeed());
  CAPTURE(Catch::rngSeed());
  FrameWriter writer;
  Bytes stream;
  std::vector<Bytes> frames;
  for (int i = 0; i < 60; ++i) {
    const bool is_long = i % 7 == 0;
    frames.push_back(frame_of(writer, is_long ? kFragmentBytesMax : 1 + rng.below(500)));
    stream.insert(stream.end(), frames.back().begin(), frames.back().end());
  }
  FrameCutter cutter;
  std::vector<Bytes> cut;
  for (std::size_t at = 0; at < stream.size();) {
    cutter.drop_taken();
    const auto room = cutter.room();
    REQUIRE_FALSE(room.empty());
    const std::size_t bytes =
        std::min({room.size(), stream.size() - at, std::size_t{1} + rng.below(40'000)});
    std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(at), bytes, room.begin());
    cutter.add(bytes);
    at += bytes;
    while (const auto frame = cutter.next()) cut.emplace_back(frame->begin(), frame->end());
  }
  CHECK(cut == frames);
  CHECK(cutter.is_between_frames());
  CHECK_FALSE(cutter.broken());
}

TEST_CASE("a goodbye among the frames is noticed", "[web]") {
  FrameCutter cutter;
  const auto take = [&](const Bytes& frame) {
    cutter.drop_taken();
    std::copy(frame.begin(), frame.end(), cutter.room().begin());
    cutter.add(frame.size());
    REQUIRE(cutter.next().has_value());
    return cutter.has_goodbye();
  };
  CHECK_FALSE(take(frame_of(20)));
  Bytes goodbye = frame_of(20);
  goodbye[2] = wire_number(kKindOf<Goodbye>);
  CHECK(take(goodbye));
  CHECK(take(frame_of(20)));
}

TEST_CASE("a stream with a header that no frame has is broken", "[web]") {
  for (const std::size_t length : {std::size_t{0}, kFragmentBytesMax + 1, std::size_t{65'535}}) {
    FrameCutter cutter;
    const auto room = cutter.room();
    std::fill_n(room.begin(), kFrameHeaderBytes, std::uint8_t{0});
    room[0] = static_cast<std::uint8_t>(length);
    room[1] = static_cast<std::uint8_t>(length >> 8);
    cutter.add(kFrameHeaderBytes);
    CHECK_FALSE(cutter.next().has_value());
    CHECK(cutter.broken());
  }
}

TEST_CASE("the header of a message to a browser has its length in the shortest form", "[web]") {
  const auto header = [](std::size_t bytes) {
    Bytes out;
    append_web_header(out, bytes);
    return out;
  };
  CHECK(header(0) == Bytes{0x82, 0});
  CHECK(header(125) == Bytes{0x82, 125});
  CHECK(header(126) == Bytes{0x82, 126, 0, 126});
  CHECK(header(65'535) == Bytes{0x82, 126, 0xff, 0xff});
  CHECK(header(65'536) == Bytes{0x82, 127, 0, 0, 0, 0, 0, 1, 0, 0});
}
