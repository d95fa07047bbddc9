#include "protocol/codec/frame.hpp"

#include <algorithm>

#include "protocol/codec/message_table.hpp"

namespace runstone {
namespace {

constexpr std::uint8_t kFlagMore = 1;
constexpr std::size_t kMessageBytesKept = 4 * kFragmentBytesMax;
// Bodies are read in place and must be 8-aligned; std::vector takes its storage from operator new.
static_assert(__STDCPP_DEFAULT_NEW_ALIGNMENT__ >= 8);

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

FrameHeader FrameWriter::next(MessageKind kind, std::size_t body_bytes, bool more) {
  RUNSTONE_ASSERT(kind < kMessageKindCount);
  RUNSTONE_ASSERT(body_bytes > 0 && body_bytes <= kFragmentBytesMax);
  const std::uint32_t count = counter_++;
  const auto byte = [](std::size_t v, int i) { return static_cast<std::uint8_t>(v >> (8 * i)); };
  return {byte(body_bytes, 0), byte(body_bytes, 1),
          wire_number(kind),   static_cast<std::uint8_t>(more ? kFlagMore : 0),
          byte(count, 0),      byte(count, 1),
          byte(count, 2),      byte(count, 3)};
}

void FrameWriter::append(const EncodedMessage& message, Bytes& out) {
  ByteView left(*message.bytes);
  RUNSTONE_ASSERT(!left.empty());
  while (!left.empty()) {
    const ByteView body = left.first(std::min(left.size(), kFragmentBytesMax));
    left = left.subspan(body.size());
    const FrameHeader header = next(message.kind, body.size(), !left.empty());
    out.insert(out.end(), header.begin(), header.end());
    out.insert(out.end(), body.begin(), body.end());
  }
}

Result<void> FrameReader::feed(ByteView bytes, const OnMessage& on_message) {
  if (broken_) return failure(*broken_);
  auto result = advance(bytes, on_message);
  if (!result) broken_ = result.error();
  return result;
}

std::size_t FrameReader::completed_bytes_max(std::size_t bytes) const {
  if (bytes < body_left_) return 0;
  for (const Partial& partial : partial_) bytes += partial.bytes.size();
  return bytes;
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
    Partial& partial = partial_[class_];
    partial.bytes.insert(partial.bytes.end(), bytes.begin(),
                         bytes.begin() + static_cast<std::ptrdiff_t>(take));
    offset_ += take;
    frame_bytes_[class_] += take;
    body_left_ -= take;
    bytes = bytes.subspan(take);
    if (body_left_ > 0) return {};
    header_have_ = 0;
    if (more_) continue;
    if (auto ok = on_message(partial.kind, partial.bytes); !ok) return ok;
    // After a large message the reader gives its memory back.
    if (partial.bytes.capacity() > kMessageBytesKept) {
      Bytes().swap(partial.bytes);
    } else {
      partial.bytes.clear();
    }
  }
  return {};
}

Result<void> FrameReader::open_frame() {
  ByteReader in(header_);
  const std::uint16_t length = in.u16();
  const std::uint8_t number = in.u8();
  const std::uint8_t flags = in.u8();
  const std::uint32_t counter = in.u32();
  const std::uint64_t at = offset_ - kFrameHeaderBytes;
  if (length == 0 || length > kFragmentBytesMax)
    return fail(ErrorCode::limit_exceeded, "frame length outside 1..16384", at);
  if (number == 0 || number > kMessageKindCount)
    return fail(ErrorCode::unknown_kind, "unknown kind of message", at);
  const MessageKind kind = number - 1u;
  const MessageInfo& info = info_of(kind);
  if (!may_send(info, sender_))
    return fail(ErrorCode::unknown_kind, "kind of message not allowed from this side", at);
  if ((flags & ~kFlagMore) != 0) return fail(ErrorCode::bad_value, "unknown frame flags", at);
  if (counter != counter_)
    return fail(ErrorCode::broken_invariant, "frame counter is out of order", at);
  class_ = static_cast<std::size_t>(info.frame_class);
  Partial& partial = partial_[class_];
  if (!partial.bytes.empty() && partial.kind != kind)
    return fail(ErrorCode::broken_invariant, "frame interrupts a message of its class", at);
  if (length > message_bytes_max(sender_, info.frame_class) - partial.bytes.size())
    return fail(ErrorCode::limit_exceeded, "message exceeds the limit of its class", at);
  partial.kind = kind;
  more_ = (flags & kFlagMore) != 0;
  ++counter_;
  frame_bytes_[class_] += kFrameHeaderBytes;
  ++frames_[class_];
  body_left_ = length;
  return {};
}

}  // namespace runstone
