#include "tests/support/sql/wire_request.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone::test {
namespace {

WireMessage simple_query(std::string sql) { return {'Q', std::move(sql) + '\0'}; }

/// Returns a Parse of a text that is no SQL, and a Sync.
std::string failing_parse() {
  using namespace std::string_literals;
  return WireMessage{'P', "\0fault\0\0\0"s}.bytes() + WireMessage{'S', ""}.bytes();
}

bool is_statement(const WireMessage& message) {
  return message.type == 'Q' || message.type == 'P' || message.type == 'E';
}

}  // namespace

std::optional<WireRequest> WireRequest::read(int client) {
  std::vector<WireMessage> messages;
  for (;;) {
    auto message = read_message(client);
    if (!message) return std::nullopt;
    messages.push_back(*std::move(message));
    const char type = messages.back().type;
    if (type == 'Q' || type == 'S' || type == 'X') return WireRequest(std::move(messages));
  }
}

std::size_t WireRequest::statements() const {
  return static_cast<std::size_t>(std::count_if(messages_.begin(), messages_.end(), is_statement));
}

std::string WireRequest::bytes_before(std::size_t statement) const {
  // The messages that bind values for an execution come before it and belong to it.
  std::string before, bytes;
  std::size_t passed = 0;
  for (const WireMessage& message : messages_) {
    if (passed == statement) return before;
    bytes += message.bytes();
    if (!is_statement(message)) continue;
    ++passed;
    before = bytes;
  }
  RUNSTONE_ASSERT(passed == statement);
  return before;
}

std::string WireRequest::failing_bytes(std::size_t statement) const {
  if (!is_simple_query()) return bytes_before(statement) + failing_parse();
  const bool is_commit = messages_.front().body == simple_query("COMMIT").body;
  return simple_query(is_commit ? "ROLLBACK" : "fault").bytes();
}

}  // namespace runstone::test
