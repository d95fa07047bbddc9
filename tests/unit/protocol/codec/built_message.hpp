// Messages that verify as FlatBuffers and may break a rule of their own, built field by field.
#pragma once
#include <flatbuffers/flatbuffers.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <functional>
#include <vector>

#include "protocol/codec/messages.hpp"
#include "protocol/schema/runstone_generated.h"
#include "tests/support/random_message.hpp"

namespace runstone::test {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;
using Vector = Offset<flatbuffers::Vector<std::uint8_t>>;

template <class Table>
Bytes message_of(FlatBufferBuilder& b, Offset<Table> body, const char* identifier = "RUN1") {
  b.Finish(wire::CreateMessage(b, wire::BodyTraits<Table>::enum_value, body.Union()), identifier);
  return {b.GetBufferPointer(), b.GetBufferPointer() + b.GetSize()};
}

inline Vector filled(FlatBufferBuilder& b, std::size_t size) {
  return b.CreateVector(Bytes(size, std::uint8_t{7}));
}

/// Decodes a message of `sender` with the body that `build` makes.
template <class Build>
Result<Message> received(Sender sender, FrameClass frame_class, Build&& build,
                         std::uint16_t edge = kMessageEdge) {
  FlatBufferBuilder b;
  const Bytes bytes = message_of(b, build(b));
  return decode_message(sender, frame_class, bytes, edge);
}

template <class Build>
bool passes_from_client(Build&& build, FrameClass frame_class = FrameClass::control) {
  return received(Sender::client, frame_class, build).has_value();
}
template <class Build>
bool passes_from_server(Build&& build, FrameClass frame_class = FrameClass::control) {
  return received(Sender::server, frame_class, build).has_value();
}

/// Checks that unchanged fields decode, and that no message decodes whose fields one of `bends`
/// changed.
template <class Fields>
void refuses(Sender sender, FrameClass frame_class,
             const std::vector<std::function<void(Fields&)>>& bends) {
  REQUIRE(received(sender, frame_class, Fields{}).has_value());
  for (std::size_t i = 0; i < bends.size(); ++i) {
    CAPTURE(i);
    Fields fields;
    bends[i](fields);
    CHECK_FALSE(received(sender, frame_class, fields).has_value());
  }
}

constexpr std::int32_t kReach =
    kWorldLimit / kMessageEdge;  // chunk coordinates reach from -kReach to kReach - 1

}  // namespace runstone::test
