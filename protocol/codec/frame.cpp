#include "protocol/codec/frame.hpp"

#include <algorithm>

namespace runstone {
namespace {

constexpr std::uint8_t kFlagMore = 1;
constexpr std::size_t kMessageBytesKept = 4 * kFragmentBytesMax;
// Bodies are read in place and must be 16-aligned; std::vector takes its storage from operator new.
static_assert(__STDCPP_DEFAULT_NEW_ALIGNMENT__ >= 16);

}  // namespace

std::size_t message_bytes_max(Sender sender, FrameClass frame_class) {
  const bool client = sender == Sender::client;
  switch (frame_class) {
    case FrameClass::control:
      return client ? kClientControlBytesMax : kServerControlBytesMax;
    case FrameClass::edits:
      return client ? kClientEditBytesMax : kServerEditBytesMax;
    case FrameClass::chunks:
      return client ? 0 : kServerChunkBytesMax;
  }
  return 0;
}

FrameHeader FrameWriter::next(FrameClass frame_class, std::size_t body_bytes, bool more) {
  RUNSTONE_ASSERT(body_bytes > 0 && body_bytes <= kFragmentBytesMax);
  const auto length = static_cast<std::uint32_t>(body_bytes);
  const std::uint32_t count = counter_++;
  const auto byte = [](std::uint32_t v, int i) { return static_cast<std::uint8_t>(v >> (8 * i)); };
  return {byte(length, 0),
          byte(length, 1),
          byte(length, 2),
          byte(length, 3),
          static_cast<std::uint8_t>(frame_class),
          static_cast<std::uint8_t>(more ? kFlagMore : 0),
          0,
          0,
          byte(count, 0),
          byte(count, 1),
          byte(count, 2),
          byte(count, 3)};
}

void FrameWriter::append(const EncodedMessage& message, Bytes& out) {
  ByteView left(*message.bytes);
  RUNSTONE_ASSERT(!left.empty());
  while (!left.empty()) {
    const ByteView body = left.first(std::min(left.size(), kFragmentBytesMax));
    left = left.subspan(body.size());
    const FrameHeader header = next(message.frame_class, body.size(), !left.empty());
    out.insert(out.end(), header.begin(), header.end());
    out.insert(out.end(), body.begin(), body.end());
  }
}

Result<void> FrameReader::feed(ByteView bytes, const OnMessage& on_message) {
  if (broken_) return Unexpected<Error>{*broken_};
  auto result = advance(bytes, on_message);
  if (!result) broken_ = result.error();
  return result;
}

Result<void> FrameReader::advance(ByteView bytes, const OnMessage& on_message) {
  while (!bytes.empty()) {
    if (body_left_ == 0) {
      const std::size_t take = std::min(bytes.size(), kFrameHeaderBytes - header_have_);
      std::copy_n(bytes.begin(), take, header_.begin() + static_cast<std::ptrdiff_t>(header_have_));
      header_have_ += take;
      offset_ += take;
      bytes = bytes.subspan(take);
      if (header_have_ < kFrameHeaderBytes) return {};
      if (auto ok = open_frame(); !ok) return ok;
      continue;
    }
    const std::size_t take = std::min(bytes.size(), body_left_);
    Bytes& partial = partial_[header_[4]];
    partial.insert(partial.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(take));
    offset_ += take;
    frame_bytes_[header_[4]] += take;
    body_left_ -= take;
    bytes = bytes.subspan(take);
    if (body_left_ > 0) return {};
    header_have_ = 0;
    if ((header_[5] & kFlagMore) != 0) continue;
    if (auto ok = on_message(static_cast<FrameClass>(header_[4]), partial); !ok) return ok;
    // After a large message the reader gives its memory back.
    if (partial.capacity() > kMessageBytesKept) {
      Bytes().swap(partial);
    } else {
      partial.clear();
    }
  }
  return {};
}

Result<void> FrameReader::open_frame() {
  ByteReader in(header_);
  const std::uint32_t length = in.u32();
  const std::uint8_t frame_class = in.u8();
  const std::uint8_t flags = in.u8();
  const std::uint16_t reserved = in.u16();
  const std::uint32_t counter = in.u32();
  const std::uint64_t at = offset_ - kFrameHeaderBytes;
  if (length == 0 || length > kFragmentBytesMax) {
    return fail(ErrorCode::limit_exceeded, "frame length outside 1..16384", at);
  }
  if (frame_class >= kFrameClassCount)
    return fail(ErrorCode::unknown_kind, "unknown frame class", at);
  if ((flags & ~kFlagMore) != 0) return fail(ErrorCode::bad_value, "unknown frame flags", at);
  if (reserved != 0)
    return fail(ErrorCode::bad_value, "reserved bytes of a frame are not zero", at);
  if (counter != counter_)
    return fail(ErrorCode::broken_invariant, "frame counter is out of order", at);
  const std::size_t bytes_max = message_bytes_max(sender_, static_cast<FrameClass>(frame_class));
  if (bytes_max == 0)
    return fail(ErrorCode::unknown_kind, "frame class not allowed from this side", at);
  if (length > bytes_max - partial_[frame_class].size()) {
    return fail(ErrorCode::limit_exceeded, "message exceeds the limit of its class", at);
  }
  ++counter_;
  frame_bytes_[frame_class] += kFrameHeaderBytes;
  ++frames_[frame_class];
  body_left_ = length;
  return {};
}

}  // namespace runstone
