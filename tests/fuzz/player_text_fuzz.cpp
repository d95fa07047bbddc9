// The target reads any bytes as the texts that players and operators give: links, invite tokens,
// device codes, addresses, lists of keys, commands and lines of chat. What is understood is written as
// text that means the same, and every message about a mistake is printable.
#include <cstdint>
#include <string_view>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "protocol/codec/device_code.hpp"
#include "protocol/codec/invite_token.hpp"
#include "protocol/codec/server_link.hpp"
#include "protocol/limits.hpp"
#include "protocol/rules/chat_text.hpp"
#include "server/admin/address_range_text.hpp"
#include "server/admin/command_table.hpp"
#include "server/admin/edit_budget_text.hpp"
#include "server/admin/operators.hpp"

namespace runstone {
namespace {

constexpr TimeUs kNowUs = 1'800'000'000'000'000;

void check_link(std::string_view text) {
  const auto link = parse_server_link(text);
  if (!link) {
    RUNSTONE_ASSERT(is_printable_utf8(link.error()));
    return;
  }
  const auto again = parse_server_link(text_of(*link));
  RUNSTONE_ASSERT(again && *again == *link);
}

void check_token(std::string_view text) {
  static const KeyPair server = key_pair_of({7});
  RUNSTONE_ASSERT(!invite_of(text, WorldId{1}, server.public_key));  // nobody guesses a signature
}

void check_range(std::string_view text) {
  const auto range = parse_address_range(text);
  if (!range) return;
  if (!*range) {
    RUNSTONE_ASSERT(is_printable_utf8(range->error()));
    return;
  }
  RUNSTONE_ASSERT((*range)->range.is_canonical());
  const auto again = parse_address_range(text_of((*range)->range));
  RUNSTONE_ASSERT(again && *again && (*again)->range == (*range)->range);
}

void check_budget(std::string_view text) {
  const auto budget = parse_edit_budget(std::string(text));
  RUNSTONE_ASSERT(!budget || parse_edit_budget(text_of(*budget)) == budget);
}

void check_operators(std::string_view text) {
  const auto operators = parse_operators(text);
  RUNSTONE_ASSERT(operators || is_printable_utf8(operators.error()));
}

void check_device_code(std::string_view text) {
  const auto code = DeviceCode::parse(text);
  if (!code) return;
  const auto again = DeviceCode::parse(code->text());
  RUNSTONE_ASSERT(again && again->text() == code->text());
}

void check_command(std::string_view text) {
  const auto command = parse_command(text, kNowUs);
  RUNSTONE_ASSERT(command || (!command.error().empty() && is_printable_utf8(command.error())));
}

void check_chat_line(std::string_view text) {
  const auto line = chat_text(text);
  if (!line) {
    RUNSTONE_ASSERT(is_printable_utf8(line.error()));
    return;
  }
  const auto again = chat_text(*line);
  RUNSTONE_ASSERT(again && *again == *line && line->size() <= kChatBytesMax);
  RUNSTONE_ASSERT(with_unseen_replaced(*line) == *line);
}

}  // namespace
}  // namespace runstone

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 6 == 1) check_token(text);  // a ticket of the wire may have any bytes
  check_chat_line(text);                    // a terminal may have any bytes
  if (data[0] % 6 == 1) check_device_code(text);
  // The wire, the terminal and `control` accept only such texts.
  if (!is_printable_utf8(text)) return 0;
  switch (data[0] % 6) {
    case 0:
      check_link(text);
      break;
    case 2:
      check_range(text);
      break;
    case 3:
      check_operators(text);
      break;
    case 4:
      check_budget(text);
      break;
    case 5:
      check_command(text);
      break;
    default:
      break;
  }
  return 0;
}
