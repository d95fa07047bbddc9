#include "protocol/codec/message_table.hpp"

#include "protocol/schema/runstone_generated.h"

namespace runstone {
namespace {

static_assert(static_cast<std::size_t>(wire::Kind::MIN) == 1);
static_assert(static_cast<std::size_t>(wire::Kind::MAX) == kMessageKindCount);

bool is_stage_right(const MessageInfo& info, Sender sender, SessionStage stage) {
  if (!info.stage || *info.stage == stage) return true;
  return sender == Sender::server && *info.stage == SessionStage::open &&
         stage == SessionStage::authenticating;
}

}  // namespace

std::optional<Refusal> refusal_of(const MessageInfo& info, Sender sender, SessionStage stage,
                                  std::uint64_t features) {
  constexpr GoodbyeReason kUnexpected = GoodbyeReason::unexpected_message;
  if (!may_send(info, sender)) return Refusal{kUnexpected, "the message is not for this side"};
  if (!is_stage_right(info, sender, stage)) {
    if (sender == Sender::client && info.stage == SessionStage::open)
      return Refusal{GoodbyeReason::not_authenticated, "the handshake comes first"};
    return Refusal{kUnexpected, "the message belongs to another stage of the handshake"};
  }
  if ((info.feature & ~features) != 0)
    return Refusal{kUnexpected, "the feature of the message is not in force"};
  return std::nullopt;
}

}  // namespace runstone
