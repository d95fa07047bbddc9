#include "server/web/web_frame.hpp"

#include <algorithm>

namespace runstone {
namespace {

/// Returns the bytes of the body that a header names.
std::size_t body_bytes_of(ByteView header) {
  return static_cast<std::size_t>(header[0] | header[1] << 8);
}

}  // namespace

const char* fault_of_web_message(ByteView message) {
  if (message.size() <= kFrameHeaderBytes)
    return "a message must be one frame, and this is shorter";
  if (message.size() > kFrameBytesMax) return "a frame has at most 16392 bytes";
  if (body_bytes_of(message) != message.size() - kFrameHeaderBytes)
    return "a message must be exactly one frame";
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
  const std::size_t body = body_bytes_of(left);
  broken_ = body == 0 || body > kFragmentBytesMax;
  if (broken_ || left.size() < kFrameHeaderBytes + body) return std::nullopt;
  begin_ += kFrameHeaderBytes + body;
  return left.first(kFrameHeaderBytes + body);
}

void FrameCutter::drop_taken() {
  std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_),
            bytes_.begin() + static_cast<std::ptrdiff_t>(end_), bytes_.begin());
  end_ -= begin_;
  begin_ = 0;
}

}  // namespace runstone
