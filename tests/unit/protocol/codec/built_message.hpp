// Messages that verify as FlatBuffers and may break a rule of their own, built field by field.
#pragma once
#include <flatbuffers/flatbuffers.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <vector>

#include "protocol/codec/messages.hpp"
#include "protocol/schema/runstone_generated.h"
#include "tests/support/codec/random_message.hpp"

namespace runstone::test {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;
using Vector = Offset<flatbuffers::Vector<std::uint8_t>>;

inline Vector filled(FlatBufferBuilder& b, std::size_t size) {
  return b.CreateVector(Bytes(size, std::uint8_t{7}));
}

/// Decodes a message of type T whose table `build` makes.
template <class T, class Build>
Result<Message> received(Build&& build, std::uint16_t edge = kMessageEdge) {
  FlatBufferBuilder b;
  b.Finish(build(b));
  const Bytes bytes(b.GetBufferPointer(), b.GetBufferPointer() + b.GetSize());
  return decode_message(sender_of(kKindOf<T>), kKindOf<T>, bytes, edge);
}
template <class T, class Build>
bool passes(Build&& build, std::uint16_t edge = kMessageEdge) {
  return received<T>(build, edge).has_value();
}

/// Checks that unchanged fields decode, and that no message decodes whose fields one of `bends`
/// changed.
template <class T, class Fields>
void refuses(const std::vector<std::function<void(Fields&)>>& bends) {
  REQUIRE(passes<T>(Fields{}));
  for (std::size_t i = 0; i < bends.size(); ++i) {
    CAPTURE(i);
    Fields fields;
    bends[i](fields);
    CHECK_FALSE(passes<T>(fields));
  }
}

/// Appends the second bytes to the first ones.
inline Bytes joined(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Returns the svarints of these numbers.
inline Bytes svarints(std::initializer_list<std::int64_t> numbers) {
  Bytes bytes;
  ByteWriter out(bytes);
  for (const std::int64_t number : numbers) out.svarint(number);
  return bytes;
}
/// Returns the varints of these numbers.
inline Bytes varints(std::initializer_list<std::uint64_t> numbers) {
  Bytes bytes;
  ByteWriter out(bytes);
  for (const std::uint64_t number : numbers) out.varint(number);
  return bytes;
}
inline Bytes u64_bytes(std::uint64_t number) {
  Bytes bytes;
  ByteWriter(bytes).u64(number);
  return bytes;
}

constexpr std::int32_t kReach =
    kWorldLimit / kMessageEdge;  // chunk coordinates reach from -kReach to kReach - 1

}  // namespace runstone::test
