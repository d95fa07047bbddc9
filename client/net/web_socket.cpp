#include "client/net/web_socket.hpp"

#include <openssl/evp.h>
#include <openssl/sha.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <span>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "protocol/codec/frame.hpp"

namespace runstone {
namespace {

enum Opcode : std::uint8_t { kContinued = 0, kBinary = 2, kClose = 8, kPing = 9, kPong = 10 };
constexpr std::uint8_t kLastFragment = 0x80, kMasked = 0x80;
constexpr std::size_t kWebKeyBytes = 16, kMaskBytes = 4;

std::string base64(ByteView bytes) {
  std::string out(4 * ((bytes.size() + 2) / 3), '\0');
  // It also writes a zero behind the text, where the string has one.
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()), bytes.data(),
                  static_cast<int>(bytes.size()));
  return out;
}

/// Returns the header Sec-WebSocket-Accept that answers a key (RFC 6455, 4.2.2).
std::string accept_of(const std::string& key) {
  const std::string text = key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
  std::array<std::uint8_t, SHA_DIGEST_LENGTH> digest{};
  SHA1(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  return base64(digest);
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return out;
}

/// Returns the value of a header, or "" if there is none. `name` is in lower case.
std::string_view header_of(std::string_view head, const std::string& name) {
  const std::size_t at = lower(head).find("\r\n" + name + ":");
  if (at == std::string::npos) return "";
  const std::size_t begin = head.find_first_not_of(' ', at + name.size() + 3);
  return head.substr(begin, head.find("\r\n", begin) - begin);
}

void append_message(std::uint8_t opcode, ByteView contents, Bytes& out) {
  out.push_back(kLastFragment | opcode);
  const std::size_t bytes = contents.size();
  RUNSTONE_ASSERT(bytes < 65'536);
  if (bytes < 126) {
    out.push_back(static_cast<std::uint8_t>(kMasked | bytes));
  } else {
    out.insert(out.end(), {kMasked | 126, static_cast<std::uint8_t>(bytes >> 8),
                           static_cast<std::uint8_t>(bytes & 0xff)});
  }
  std::array<std::uint8_t, kMaskBytes> mask{};
  randombytes_buf(mask.data(), mask.size());
  out.insert(out.end(), mask.begin(), mask.end());
  const std::size_t begin = out.size();
  out.insert(out.end(), contents.begin(), contents.end());
  for (std::size_t i = 0; i < bytes; ++i) out[begin + i] ^= mask[i % kMaskBytes];
}

}  // namespace

WebSocketCodec::WebSocketCodec() {
  std::array<std::uint8_t, kWebKeyBytes> nonce{};
  randombytes_buf(nonce.data(), nonce.size());
  key_ = base64(nonce);
}

std::string WebSocketCodec::request(const std::string& host, const std::string& path) const {
  return "GET " + path + " HTTP/1.1\r\nHost: " + host +
         "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: " +
         key_ + "\r\n\r\n";
}

Result<std::size_t, std::string> WebSocketCodec::read_answer(std::string_view received) const {
  const std::size_t end = received.find("\r\n\r\n");
  if (end == std::string_view::npos) {
    if (received.size() < kAnswerBytesMax) return std::size_t{0};
    return failure("the gateway's answer is no answer of HTTP");
  }
  const std::string_view head = received.substr(0, end + 2);
  const std::string_view status = head.substr(0, head.find("\r\n"));
  if (!status.starts_with("HTTP/1.1 101")) {
    const std::string_view words = received.substr(end + 4);
    const std::string_view line = words.substr(0, words.find('\n'));
    std::string out = "the gateway opens no WebSocket: " + std::string(status);
    if (!line.empty() && is_printable_utf8(line)) out += ": " + std::string(line);
    return failure(std::move(out));
  }
  if (header_of(head, "sec-websocket-accept") != accept_of(key_))
    return failure("the gateway's answer is for another WebSocket");
  return end + 4;
}

void WebSocketCodec::write(ByteView frames, Bytes& out) {
  out.insert(out.end(), pongs_.begin(), pongs_.end());
  pongs_.clear();
  while (!frames.empty()) {
    RUNSTONE_ASSERT(frames.size() > kFrameHeaderBytes);
    const std::size_t bytes =
        kFrameHeaderBytes + static_cast<std::size_t>(frames[0] | frames[1] << 8);
    append_message(kBinary, frames.first(bytes), out);
    frames = frames.subspan(bytes);
  }
}

Result<void, std::string> WebSocketCodec::read(ByteView bytes, Bytes& out) {
  while (!bytes.empty()) {
    if (!is_in_frame_) {
      header_.push_back(bytes[0]);
      bytes = bytes.subspan(1);
      if (const auto started = start_frame(); !started) return started;
    }
    const std::size_t taken = std::min(left_, bytes.size());
    const ByteView contents = bytes.first(taken);
    bytes = bytes.subspan(taken);
    left_ -= taken;
    const bool is_control = is_in_frame_ && (header_[0] & 0x0f) >= kClose;
    Bytes& into = is_control ? control_ : out;
    into.insert(into.end(), contents.begin(), contents.end());
    if (!is_in_frame_ || left_ > 0) continue;
    if (is_control) {
      if (const auto ended = end_control(); !ended) return ended;
    }
    header_.clear();
    is_in_frame_ = false;
  }
  return {};
}

Result<void, std::string> WebSocketCodec::start_frame() {
  if (header_.size() < 2) return {};
  const std::size_t first = header_[1];
  if (first >= kMasked) return failure("the gateway sent a masked frame");
  const std::size_t more = first < 126 ? 0 : first == 126 ? 2 : 8;
  if (header_.size() < 2 + more) return {};
  std::uint64_t length = more == 0 ? first : 0;
  for (std::size_t i = 0; i < more; ++i) length = length << 8 | header_[2 + i];
  const std::uint8_t opcode = header_[0] & 0x0f;
  const bool is_last = (header_[0] & kLastFragment) != 0;
  if (opcode >= kClose) {
    if (!is_last || length > kControlBytesMax)
      return failure("the gateway sent a control frame that is too long");
    control_.clear();
  } else {
    if (opcode != (is_in_message_ ? kContinued : kBinary))
      return failure("the gateway sent something else than binary messages");
    is_in_message_ = !is_last;
  }
  left_ = static_cast<std::size_t>(length);
  is_in_frame_ = true;
  return {};
}

Result<void, std::string> WebSocketCodec::end_control() {
  const std::uint8_t opcode = header_[0] & 0x0f;
  // A gateway that sends pings without end gets no more answers than fit into a buffer.
  constexpr std::size_t kPongsBytesMax = 4 * 1024;
  if (opcode == kPing && pongs_.size() < kPongsBytesMax) append_message(kPong, control_, pongs_);
  if (opcode != kClose) return {};
  const std::string words(control_.size() < 2 ? control_.end() : control_.begin() + 2,
                          control_.end());
  return failure("the gateway closed the WebSocket" +
                 (words.empty() || !is_printable_utf8(words) ? "" : ": " + words));
}

}  // namespace runstone
