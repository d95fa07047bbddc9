// WireMessage: one message of PostgreSQL's protocol, version 3, as a fault proxy reads and sends it.
// Source: PostgreSQL's documentation, "Message Formats".
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace runstone::test {

struct WireMessage {
  char type = 0;     // 0: a message without a type, with which a client begins a connection
  std::string body;  // without type and length

  std::string bytes() const;
  /// Returns the integer at the begin of the body, or -1 if the body is shorter.
  int first_integer() const;
};

std::string bytes_of(const std::vector<WireMessage>& messages);

/// Reads a message. Returns nullopt if the peer has closed the connection.
std::optional<WireMessage> read_message(int socket);
/// Reads the message without a type.
std::optional<WireMessage> read_untyped_message(int socket);
/// Returns false if the peer has closed the connection.
bool send_bytes(int socket, std::string_view bytes);

/// Returns the ErrorResponse of a server. `severity` is ERROR, or FATAL if the session ends.
WireMessage error_response(const std::string& severity, const std::string& sqlstate,
                           const std::string& text);

}  // namespace runstone::test
