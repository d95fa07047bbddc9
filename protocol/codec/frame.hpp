// Frames: how messages become a byte stream and come back. One stream carries three classes whose fragments
// may interleave, so that an edit overtakes terrain; within a class, messages keep their order. Header, 12
// bytes, little-endian:
//   u32 body bytes (1 .. 16 KiB) | u8 class | u8 flags (bit 0: more fragments of this message follow) | u16
//   zero | u32 counter (frames sent in this direction before this one, modulo 2^32)
// The counter detects a peer that loses, repeats or invents frames before its bytes reach the decoder.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "protocol/limits.hpp"

namespace runstone {

/// Values are on the wire.
enum class FrameClass : std::uint8_t { control = 0, edits = 1, chunks = 2 };
inline constexpr int kFrameClassCount = 3;

/// Whose bytes are read: decides which classes, sizes and messages are allowed.
enum class Sender : std::uint8_t { client, server };
std::size_t message_bytes_max(Sender sender,
                              FrameClass frame_class);  // 0: this sender may not use the class

/// A serialised message: made once, shared by every session that sends it.
struct EncodedMessage {
  FrameClass frame_class = FrameClass::control;
  std::shared_ptr<const Bytes> bytes;
};

using FrameHeader = std::array<std::uint8_t, kFrameHeaderBytes>;

/// Cuts messages into frames of one direction and counts them. One per session and direction; one thread.
class FrameWriter {
 public:
  /// Header of the next fragment: `body_bytes` of 1 .. kFragmentBytesMax; `more` if the message goes on.
  FrameHeader next(FrameClass frame_class, std::size_t body_bytes, bool more);
  /// Appends a whole message as consecutive frames; for tests and small peers. Real senders interleave.
  void append(const EncodedMessage& message, Bytes& out);

 private:
  std::uint32_t counter_ = 0;
};

/// Puts frames back together. Feed it the stream in pieces of any size; it hands out whole messages in order
/// of completion. Holds at most one unfinished message per class, each below its limit. One thread. After an
/// error, its own or one that on_message returned, every call returns that error. Offsets of its own errors
/// count bytes since the stream began and name the frame's first byte.
class FrameReader {
 public:
  explicit FrameReader(Sender sender) : sender_(sender) {}
  /// Called with the class and the body; the body is 16-aligned and lives until the call returns. The handler
  /// must not feed the same reader.
  using OnMessage = std::function<Result<void>(FrameClass, ByteView)>;
  Result<void> feed(ByteView bytes, const OnMessage& on_message);
  /// Bytes of frames of this class read so far, headers included, whole frames or not.
  std::uint64_t frame_bytes(FrameClass frame_class) const {
    return frame_bytes_[static_cast<std::size_t>(frame_class)];
  }
  /// Frames of this class whose header was read.
  std::uint64_t frames(FrameClass frame_class) const {
    return frames_[static_cast<std::size_t>(frame_class)];
  }

 private:
  Result<void> advance(ByteView bytes, const OnMessage& on_message);
  Result<void> open_frame();

  Sender sender_;
  std::optional<Error> broken_;
  std::uint64_t offset_ = 0;
  std::uint32_t counter_ = 0;
  std::array<std::uint8_t, kFrameHeaderBytes> header_{};
  std::size_t header_have_ = 0;
  std::size_t body_left_ = 0;
  std::array<Bytes, kFrameClassCount> partial_;
  std::array<std::uint64_t, kFrameClassCount> frame_bytes_{}, frames_{};
};

}  // namespace runstone
