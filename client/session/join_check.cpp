#include "client/session/join_check.hpp"

#include "common/core/text.hpp"
#include "protocol/limits.hpp"

namespace runstone {

Result<void, std::string> check_player_name(std::string_view name) {
  if (name.empty()) return failure("a name has at least one character");
  if (name.size() > kPlayerNameBytesMax) {
    return failure("a name has at most " + std::to_string(kPlayerNameBytesMax) +
                   " bytes, and this one has " + std::to_string(name.size()) +
                   "; a letter outside of English takes 2 to 4 bytes");
  }
  if (!is_plain_name(name))
    return failure(
        "a name has no quotes, backslashes or unseen characters, and no blank at its ends");
  return {};
}

Result<void, std::string> check_ticket(std::string_view ticket) {
  if (ticket.size() <= kTicketBytesMax && is_printable_utf8(ticket)) return {};
  return failure("the invite in this link is damaged; copy the whole link again");
}

}  // namespace runstone
