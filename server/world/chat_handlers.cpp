#include "server/world/chat_handlers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/text.hpp"
#include "protocol/rules/chat_text.hpp"
#include "server/world/rights_handlers.hpp"

namespace runstone {
namespace {

// Bytes that count as read, so that lines that gain nothing do not keep the world busy: with the
// default `read_kib_per_second`, a session gets some 110 refusals a second.
constexpr std::size_t kRefusedLineBytes = 4'096;

/// Why a line is not passed on.
struct ChatRefusal {
  std::string text;  // for the player
  std::string what;  // for moderators: without numbers that differ each time
};

std::string again_in(TimeUs wait_us) {
  return fmt::format(": again in {:.1f} s", static_cast<double>(wait_us) / 1e6);
}

bool has_chat(const WorldSession& session) {
  return session.state == SessionStage::open && (session.features & kFeatureChat) != 0;
}

/// Returns the time of a line: that of the log, which a wrong clock does not set back.
TimeUs time_of_line(WorldState& world, const Clocks& now) {
  world.authority.log_clock().advance(now);  // commits do it too, but the first one may come later
  return world.authority.log_clock().time();
}

/// Returns how long the author must wait until the same line may come again: 0 if it may come now.
/// Cost: O(kChatRecentMax + kChatLinesMax).
TimeUs repeat_wait_us(const WorldState& world, AuthorId author, const std::string& text,
                      TimeUs now_us) {
  TimeUs wait_us = 0;
  const auto look_at = [&](const ChatLine& line) {
    const TimeUs age_us = now_us - line.utc_us;
    if (line.author == author && line.text == text && age_us >= 0)
      wait_us = std::max(wait_us, kChatRepeatUs - age_us);
  };
  std::for_each(world.chat.recent.begin(), world.chat.recent.end(), look_at);
  std::for_each(world.chat.waiting.begin(), world.chat.waiting.end(), look_at);
  return wait_us;
}

/// Takes the price of a line from the budgets of the player, the address and the server. Returns the
/// refusal, and takes nothing, if one of them is used up.
std::optional<ChatRefusal> pay_line(WorldState& world, const WorldSession& mine, TimeUs now_us) {
  if (const TimeUs wait_us = world.chat.all.wait_us(1, now_us); wait_us > 0)
    return ChatRefusal{"too many players write at once" + again_in(wait_us), "too many at once"};
  const auto unpaid = world.chat.ledger.charge({mine.key, mine.address, world.config.chat_budget},
                                               kChatPrice, now_us);
  if (!unpaid) {
    world.chat.all.take(1, now_us);
    return std::nullopt;
  }
  const bool is_of_key = std::string_view(unpaid->whose) == "key";
  return ChatRefusal{(is_of_key ? "you write too fast" : "too many lines come from your address") +
                         again_in(unpaid->wait_us),
                     is_of_key ? "too fast" : "too fast from one address"};
}

void refuse_line(WorldState& world, SessionId session, const ChatRefusal& refusal,
                 const Clocks& now) {
  WorldSession& mine = *world.find(session);
  world.output.charge_reading(session, kRefusedLineBytes);
  world.refusals.add(mine.key, "chat: " + refusal.what, now.utc_us);
  if (!mine.chat_answers.take(1, now.steady_us)) return;
  ChatLine line;
  line.kind = ChatLineKind::refused;
  line.text = cut_utf8(refusal.text, kChatBytesMax);
  line.utc_us = time_of_line(world, now);
  send_or_skip(world, session, encode_message(ChatLines{{std::move(line)}}));
}

void add_line(WorldState& world, ChatLine line, const PublicKey& by) {
  if (!world.disk_is_full) world.environment.log_chat({line, by});  // the rest is for edits
  world.chat.waiting.push_back(std::move(line));
  if (world.chat.waiting.size() == kChatLinesMax) broadcast_chat(world);
}

}  // namespace

void on_chat(WorldState& world, SessionId session, const ChatRequest& request, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  const auto refuse = [&](const ChatRefusal& why) { refuse_line(world, session, why, now); };
  auto text = chat_text(request.text);
  if (!text) return refuse({text.error(), text.error()});
  if (const auto why = chat_refusal(world, mine.key)) return refuse({*why, *why});
  const TimeUs utc_us = time_of_line(world, now);
  if (const TimeUs wait_us = repeat_wait_us(world, mine.author, *text, utc_us); wait_us > 0)
    return refuse({"you wrote that just now" + again_in(wait_us), "the same line again"});
  if (const auto unpaid = pay_line(world, mine, now.steady_us)) return refuse(*unpaid);
  add_line(world, {ChatLineKind::player, mine.author, mine.name, *std::move(text), utc_us},
           mine.key);
}

std::size_t say(WorldState& world, const std::string& text, const PublicKey& by,
                const Clocks& now) {
  add_line(world, {ChatLineKind::server, 0, "", text, time_of_line(world, now)}, by);
  return static_cast<std::size_t>(
      std::count_if(world.sessions.begin(), world.sessions.end(),
                    [](const auto& entry) { return has_chat(entry.second); }));
}

void tell(WorldState& world, SessionId session, const std::string& text, const Clocks& now) {
  if (!has_chat(*world.find(session))) return;
  const ChatLine line{ChatLineKind::server, 0, "", text, time_of_line(world, now)};
  send_or_skip(world, session, encode_message(ChatLines{{line}}));
}

void send_recent_chat(WorldState& world, SessionId session, const Clocks& now) {
  if (!has_chat(*world.find(session))) return;
  ChatLines recent{{world.chat.recent.begin(), world.chat.recent.end()}};
  const std::string& today = world.config.message_of_the_day;
  if (!today.empty())
    recent.lines.push_back(
        {ChatLineKind::message_of_the_day, 0, "", today, time_of_line(world, now)});
  if (!recent.lines.empty()) send_or_skip(world, session, encode_message(recent));
}

void broadcast_chat(WorldState& world) {
  if (world.chat.waiting.empty()) return;
  const ChatLines lines{std::exchange(world.chat.waiting, {})};
  std::vector<SessionId> readers;
  for (const auto& [id, session] : world.sessions) {
    if (has_chat(session)) readers.push_back(id);
  }
  world.counters.queue_full += world.output.send_to_all(readers, encode_message(lines)).size();
  for (const ChatLine& line : lines.lines) world.chat.add(line);
}

}  // namespace runstone
