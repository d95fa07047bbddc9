// WireRequest: what a client of PostgreSQL sends until it waits for an answer. It is a simple query,
// or the messages of the extended protocol up to a Sync, which have one statement or several
// (libpq's pipeline mode).
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/sql/wire_message.hpp"

namespace runstone::test {

class WireRequest {
 public:
  /// Reads a request. Returns nullopt if the client has closed the connection.
  static std::optional<WireRequest> read(int client);

  /// Returns the number of statements: each simple query, each preparation and each execution. It is
  /// 0 if the client ends the session.
  std::size_t statements() const;
  std::string bytes() const { return bytes_of(messages_); }
  /// Returns the part before a statement, which counts from 0.
  std::string bytes_before(std::size_t statement) const;
  /// Returns a request that fails at this statement. The server then aborts the transaction, as it does
  /// after each error, so its later answers are true. Instead of COMMIT it rolls back, and does not
  /// fail.
  std::string failing_bytes(std::size_t statement) const;

 private:
  explicit WireRequest(std::vector<WireMessage> messages) : messages_(std::move(messages)) {}
  bool is_simple_query() const { return messages_.front().type == 'Q'; }

  std::vector<WireMessage> messages_;
};

}  // namespace runstone::test
