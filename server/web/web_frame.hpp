// Frames between a WebSocket and the stream of the server. A binary message of a browser is one
// frame of the protocol as it is in the stream, with its header (protocol/codec/frame.hpp). A
// message to a browser is one frame or several. So bytes pass in both directions unchanged, and
// only their bounds are looked at here.
#pragma once
#include <cstddef>
#include <optional>
#include <span>

#include "common/core/bytes.hpp"
#include "protocol/limits.hpp"

namespace runstone {

inline constexpr std::size_t kFrameBytesMax = kFrameHeaderBytes + kFragmentBytesMax;

/// Returns a sentence about why the message is not exactly one frame, or nullptr if it is. Of the
/// header only the length is read; the server checks the rest.
const char* fault_of_web_message(ByteView message);

/// Appends the header of a WebSocket's message to a browser: binary, in one fragment, not masked
/// (RFC 6455). `bytes`: of its contents.
void append_web_header(Bytes& out, std::size_t bytes);

/// Cuts the server's stream into frames. It holds at most two frames. Thread: one.
class FrameCutter {
 public:
  FrameCutter() : bytes_(2 * kFrameBytesMax) {}

  /// Returns the room for what is read next. It is empty only while a whole frame has not been
  /// taken.
  std::span<std::uint8_t> room() { return std::span(bytes_).subspan(end_); }
  /// Reports that so many bytes were read into room().
  void add(std::size_t bytes) { end_ += bytes; }
  /// Returns the next whole frame, or nullopt if more bytes are needed, or broken() holds. The view
  /// lives until the next call of another function.
  std::optional<ByteView> next();
  /// Makes room behind the frames that were taken. Call it before room().
  void drop_taken();
  /// Returns true if the stream has a header that no frame has.
  bool broken() const { return broken_; }
  /// Returns true if the server has said goodbye: one of the frames taken was its last message.
  bool has_goodbye() const { return has_goodbye_; }
  /// Returns true if the stream stands between two frames.
  bool is_between_frames() const { return begin_ == end_; }

 private:
  Bytes bytes_;
  std::size_t begin_ = 0, end_ = 0;  // what was read and not taken
  bool broken_ = false;
  bool has_goodbye_ = false;
};

}  // namespace runstone
