#include "tests/support/sql/wire_message.hpp"

#include <sys/socket.h>

#include <cstddef>
#include <cstdint>

namespace runstone::test {
namespace {

constexpr std::size_t kLengthBytes = 4;

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

std::uint32_t number_of(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char byte : bytes.substr(0, kLengthBytes))
    value = value << 8 | static_cast<std::uint8_t>(byte);
  return value;
}

bool receive(int socket, std::string& bytes) {
  std::size_t count = 0;
  while (count < bytes.size()) {
    const ssize_t got = ::recv(socket, bytes.data() + count, bytes.size() - count, 0);
    if (got <= 0) return false;
    count += static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

std::string WireMessage::bytes() const {
  const auto length = static_cast<std::uint32_t>(kLengthBytes + body.size());
  return (type == 0 ? std::string() : std::string(1, type)) + big_endian(length) + body;
}

int WireMessage::first_integer() const {
  return body.size() < kLengthBytes ? -1 : static_cast<int>(number_of(body));
}

std::string bytes_of(const std::vector<WireMessage>& messages) {
  std::string bytes;
  for (const WireMessage& message : messages) bytes += message.bytes();
  return bytes;
}

std::optional<WireMessage> read_untyped_message(int socket) {
  std::string length(kLengthBytes, '\0');
  if (!receive(socket, length) || number_of(length) < kLengthBytes) return std::nullopt;
  WireMessage message;
  message.body.resize(number_of(length) - kLengthBytes);
  if (!receive(socket, message.body)) return std::nullopt;
  return message;
}

std::optional<WireMessage> read_message(int socket) {
  std::string type(1, '\0');
  if (!receive(socket, type)) return std::nullopt;
  auto message = read_untyped_message(socket);
  if (message) message->type = type[0];
  return message;
}

bool send_bytes(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

WireMessage error_response(const std::string& severity, const std::string& sqlstate,
                           const std::string& text) {
  const std::string end(1, '\0');
  return {'E', "S" + severity + end + "V" + severity + end + "C" + sqlstate + end + "M" + text +
                   end + end};
}

}  // namespace runstone::test
