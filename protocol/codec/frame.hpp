// Frames: they carry messages in a byte stream. One stream carries three classes. Fragments of
// different classes may interleave, so that an edit overtakes terrain. Within a class, messages
// keep their order. A frame is a header of 8 bytes, little-endian, and a body:
//   u16 bytes of the body (1 .. 16 KiB) | u8 kind of the message, which decides its class |
//   u8 flags (bit 0: more fragments of this message follow) |
//   u32 counter (frames sent in this direction before this one, modulo 2^32)
// The counter detects lost, repeated and invented frames before their bytes reach the decoder.
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

/// Index of a message's type in Message (messages.hpp) and in kMessageTable. On the wire it is one
/// more: the enum Kind of the schema begins with 1.
using MessageKind = std::size_t;

/// Kinds of one class keep their order. Kinds of different classes overtake each other.
enum class FrameClass : std::uint8_t { control = 0, edits = 1, chunks = 2 };
inline constexpr int kFrameClassCount = 3;

/// The side that sent the bytes. It decides which kinds and sizes of messages are allowed.
enum class Sender : std::uint8_t { client, server };
/// Returns the limit of a whole message, or 0 if the sender may not use the class.
std::size_t message_bytes_max(Sender sender, FrameClass frame_class);

/// A serialised message. It is made once and shared by all sessions that send it.
struct EncodedMessage {
  MessageKind kind = 0;
  std::shared_ptr<const Bytes> bytes;
};

using FrameHeader = std::array<std::uint8_t, kFrameHeaderBytes>;

/// Makes the frames of one direction of a session and counts them. Thread: one.
class FrameWriter {
 public:
  /// Returns the header of the next fragment. `more` says that the message continues in another
  /// fragment. Requires body_bytes in 1 .. kFragmentBytesMax.
  FrameHeader next(MessageKind kind, std::size_t body_bytes, bool more);
  /// Appends a whole message as consecutive frames, for senders that do not interleave classes.
  void append(const EncodedMessage& message, Bytes& out);

 private:
  std::uint32_t counter_ = 0;
};

/// Reads frames and assembles messages. Accepts the stream in pieces of any size and delivers
/// messages in the order in which they become complete. Holds at most one unfinished message per
/// class, each below its limit. After an error of its own or of on_message, every call returns that
/// error. Offsets of its own errors count bytes since the stream began and name the first byte of
/// the frame. Thread: one.
class FrameReader {
 public:
  explicit FrameReader(Sender sender) : sender_(sender) {}
  /// Gets the kind and the bytes of a message. The sender may send this kind. The bytes are
  /// 8-aligned and live until the call returns. It must not feed the same reader.
  using OnMessage = std::function<Result<void>(MessageKind, ByteView)>;
  Result<void> feed(ByteView bytes, const OnMessage& on_message);
  /// Returns an upper bound of the bytes of messages that the next `bytes` bytes may complete.
  std::size_t completed_bytes_max(std::size_t bytes) const;
  /// Returns the bytes read of frames of this class, headers and unfinished frames included.
  std::uint64_t frame_bytes(FrameClass frame_class) const {
    return frame_bytes_[static_cast<std::size_t>(frame_class)];
  }
  /// Returns the number of frames of this class whose headers were read.
  std::uint64_t frames(FrameClass frame_class) const {
    return frames_[static_cast<std::size_t>(frame_class)];
  }

 private:
  /// A message of which some fragments were read.
  struct Partial {
    MessageKind kind = 0;
    Bytes bytes;
  };

  Result<void> advance(ByteView bytes, const OnMessage& on_message);
  Result<void> open_frame();

  Sender sender_;
  std::optional<Error> broken_;
  std::uint64_t offset_ = 0;
  std::uint32_t counter_ = 0;
  std::array<std::uint8_t, kFrameHeaderBytes> header_{};
  std::size_t header_have_ = 0;
  // Of the frame that is being read.
  std::size_t class_ = 0;
  bool more_ = false;
  std::size_t body_left_ = 0;
  std::array<Partial, kFrameClassCount> partial_;
  std::array<std::uint64_t, kFrameClassCount> frame_bytes_{}, frames_{};
};

}  // namespace runstone
