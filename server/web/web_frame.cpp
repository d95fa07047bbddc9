#include "server/web/web_frame.hpp"

#include <algorithm>

#include "protocol/codec/frame_bytes.hpp"
#include "protocol/codec/message_table.hpp"

namespace runstone {

const char* fault_of_web_message(ByteView message) {
  if (message.size() <= kFrameHeaderBytes)
    return "a message must be one frame, and this is shorter";
  if (message.size() > kFrameBytesMax) return "a frame has at most 16392 bytes";
  if (frame_bytes(message) != message.size()) return "a message must be exactly one frame";
  return nullptr;
}

void append_web_header(Bytes& out, std::size_t bytes) {
  constexpr std::uint8_t kLastBinary = 0x82;
  out.push_back(kLastBinary);
  const int length_bytes = bytes < 126 ? 0 : bytes < 65'536 ? 2 : 8;
  out.push_back(static_cast<std::uint8_t>(length_bytes == 0   ? bytes
                                          : length_bytes == 2 ? 126
                                                              : 127));
  for (int i = length_bytes - 1; i >= 0; --i)
    out.push_back(static_cast<std::uint8_t>(bytes >> (8 * i)));
}

std::optional<ByteView> FrameCutter::next() {
  const ByteView left = ByteView(bytes_).subspan(begin_, end_ - begin_);
  if (broken_ || left.size() < kFrameHeaderBytes) return std::nullopt;
  const std::size_t bytes = frame_bytes(left);
  broken_ = bytes == kFrameHeaderBytes || bytes > kFrameBytesMax;
  if (broken_ || left.size() < bytes) return std::nullopt;
  begin_ += bytes;
  constexpr std::size_t kKindAt = 2;  // frame.hpp
  has_goodbye_ = has_goodbye_ || left[kKindAt] == wire_number(kKindOf<Goodbye>);
  return left.first(bytes);
}

void FrameCutter::drop_taken() {
  std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_),
            bytes_.begin() + static_cast<std::ptrdiff_t>(end_), bytes_.begin());
  end_ -= begin_;
  begin_ = 0;
}

}  // namespace runstone
