// WebSocketCodec: the client's end of a WebSocket (RFC 6455) as a link to a gateway needs it. A
// binary message is one frame of the protocol (docs/protocol.md). Without a socket: bytes come in
// as arguments. It accepts what a gateway may send, which includes fragments and pings.
// Thread: one.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

class WebSocketCodec {
 public:
  static constexpr std::size_t kAnswerBytesMax = 8 * 1024;

  WebSocketCodec();

  /// Returns the request that opens the WebSocket. `host`: HOST:PORT; `path` begins with '/'.
  std::string request(const std::string& host, const std::string& path) const;
  /// Reads the answer to the request. Returns its size, or 0 if it is not complete. Fails if it
  /// opens no WebSocket; the text has the status and the words of the gateway.
  Result<std::size_t, std::string> read_answer(std::string_view received) const;

  /// Appends whole frames of the protocol to `out` as messages. Answers to pings come before them.
  /// Requires that `frames` ends with the end of a frame.
  void write(ByteView frames, Bytes& out);
  /// Appends the contents of messages to `out`. The bytes may end anywhere. Fails if they break a
  /// rule, and at the close frame; the text has the words of the gateway.
  Result<void, std::string> read(ByteView bytes, Bytes& out);

 private:
  static constexpr std::size_t kControlBytesMax = 125;

  Result<void, std::string> start_frame();
  Result<void, std::string> end_control();

  std::string key_;
  Bytes header_;                // of the frame that is read now, as far as it has come
  std::size_t left_ = 0;        // bytes of its contents that have not come
  bool is_in_frame_ = false;    // the header is complete
  bool is_in_message_ = false;  // the last frame of data was not the last one of its message
  Bytes control_;               // contents of a control frame
  Bytes pongs_;                 // to be sent
};

}  // namespace runstone
