#include "server/world/people/chat_room.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "common/core/text.hpp"
#include "protocol/rules/chat_text.hpp"

namespace runstone {
namespace {

// Bytes that count as read, so that lines that gain nothing do not keep the world busy: with the
// default `read_kib_per_second`, a session gets some 110 refusals a second.
constexpr std::size_t kRefusedLineBytes = 4'096;

std::string again_in(TimeUs wait_us) {
  return fmt::format(": again in {:.1f} s", static_cast<double>(wait_us) / 1e6);
}

bool reads_chat(const Session& session) { return session.is_open() && session.has(kFeatureChat); }

}  // namespace

ChatRoom::ChatRoom(const WorldConfig& config, const WorldStart& start,
                   WorldEnvironment& environment, Sessions& sessions, Order& order, Rights& rights)
    : config_(config),
      environment_(environment),
      sessions_(sessions),
      order_(order),
      rights_(rights),
      state_(config.chat_budget, config.budgets_per_address) {
  for (const ChatEntry& entry : start.chat) {
    state_.add(entry);
    if (entry.line.kind == ChatLineKind::player)
      state_.sent.back().line.author = order.players().author_of(entry.key).value_or(0);
  }
}

/// Returns the time of a line: that of the log, which a wrong clock does not set back.
TimeUs ChatRoom::time_of_line(const Clocks& now) {
  LogClock& clock = order_.authority().log_clock();
  clock.advance(now);  // commits do it too, but the first one may come later
  return clock.time();
}

/// Returns how long the author must wait until the same line may come again: 0 if it may come now.
/// Cost: O(kChatKeptMax + kChatLinesMax).
TimeUs ChatRoom::repeat_wait_us(AuthorId author, const std::string& text, TimeUs now_us) const {
  TimeUs wait_us = 0;
  const auto look_at = [&](const ChatEntry& entry) {
    const ChatLine& line = entry.line;
    const TimeUs age_us = now_us - line.utc_us;
    if (line.author == author && line.text == text && age_us >= 0)
      wait_us = std::max(wait_us, kChatRepeatUs - age_us);
  };
  std::ranges::for_each(state_.sent, look_at);
  std::ranges::for_each(state_.waiting, look_at);
  return wait_us;
}

/// Takes the price of a line from the budgets of the player, the address and the server. Returns
/// the refusal, and takes nothing, if one of them is used up.
std::optional<ChatRoom::Refusal> ChatRoom::pay(const Session& session, TimeUs now_us) {
  if (const TimeUs wait_us = state_.all.wait_us(1, now_us); wait_us > 0)
    return Refusal{"too many players write at once" + again_in(wait_us), "too many at once"};
  const auto unpaid =
      state_.ledger.charge({session.key, session.address, config_.chat_budget}, kChatPrice, now_us);
  if (!unpaid) {
    state_.all.take(1, now_us);
    return std::nullopt;
  }
  const bool is_of_key = std::string_view(unpaid->whose) == "key";
  return Refusal{(is_of_key ? "you write too fast" : "too many lines come from your address") +
                     again_in(unpaid->wait_us),
                 is_of_key ? "too fast" : "too fast from one address"};
}

void ChatRoom::refuse(Session& session, const Refusal& refusal, const Clocks& now) {
  sessions_.charge_reading(session, kRefusedLineBytes);
  rights_.note_refusal(session.key, "chat: " + refusal.what, now.utc_us);
  TokenBucket& answers =
      answers_.try_emplace(session.id, kChatAnswersPerSecond, kChatAnswerBurst).first->second;
  if (!answers.take(1, now.steady_us)) return;
  ChatLine line;
  line.kind = ChatLineKind::refused;
  line.text = cut_utf8(refusal.text, kChatBytesMax);
  line.utc_us = time_of_line(now);
  sessions_.send_or_skip(session, encode_message(ChatLines{{std::move(line)}}));
}

void ChatRoom::add(ChatLine line, const PublicKey& by) {
  if (!order_.is_disk_full()) environment_.log_chat({line, by});  // the rest is for edits
  state_.waiting.push_back({std::move(line), by});
  if (state_.waiting.size() == kChatLinesMax) broadcast();
}

void ChatRoom::on_line(Session& session, const ChatRequest& request, const Clocks& now) {
  auto text = chat_text(request.text);
  if (!text) return refuse(session, {text.error(), text.error()}, now);
  if (const auto why = rights_.chat_refusal(session.key)) return refuse(session, {*why, *why}, now);
  const TimeUs utc_us = time_of_line(now);
  if (const TimeUs wait_us = repeat_wait_us(session.author, *text, utc_us); wait_us > 0)
    return refuse(session, {"you wrote that just now" + again_in(wait_us), "the same line again"},
                  now);
  if (const auto unpaid = pay(session, now.steady_us)) return refuse(session, *unpaid, now);
  add({ChatLineKind::player, session.author, session.name, *std::move(text), utc_us}, session.key);
}

std::size_t ChatRoom::say(const std::string& text, const PublicKey& by, const Clocks& now) {
  add({ChatLineKind::server, 0, "", text, time_of_line(now)}, by);
  return static_cast<std::size_t>(std::ranges::count_if(
      sessions_.open(), [](const Session* session) { return reads_chat(*session); }));
}

std::size_t ChatRoom::tell_those(const std::function<bool(const PublicKey&)>& is_meant,
                                 const std::string& text, const Clocks& now) {
  std::size_t told = 0;
  for (const Session* session : sessions_.open()) {
    if (!is_meant(session->key)) continue;
    tell(*session, text, now);
    ++told;
  }
  return told;
}

void ChatRoom::tell(const Session& session, const std::string& text, const Clocks& now) {
  if (!reads_chat(session)) return;
  const ChatLine line{ChatLineKind::server, 0, "", text, time_of_line(now)};
  sessions_.send_or_skip(session, encode_message(ChatLines{{line}}));
}

void ChatRoom::tell_of_visit(const PublicKey& player, const std::string& text, const Clocks& now) {
  std::vector<SessionId> readers;
  for (const Session* session : sessions_.open()) {
    if (reads_chat(*session) && session->has(kFeatureVisits) && session->key != player)
      readers.push_back(session->id);
  }
  if (readers.empty()) return;
  const ChatLine line{ChatLineKind::visit, 0, "", std::string(cut_utf8(text, kChatBytesMax)),
                      time_of_line(now)};
  sessions_.send_to_all(readers, encode_message(ChatLines{{line}}));
}

void ChatRoom::send_recent(const Session& session, const Clocks& now) {
  if (!reads_chat(session)) return;
  ChatLines recent;
  for (auto entry = state_.sent.rbegin(); entry != state_.sent.rend(); ++entry) {
    if (recent.lines.size() == kChatRecentMax) break;
    if (!entry->is_withdrawn) recent.lines.push_back(entry->line);
  }
  std::ranges::reverse(recent.lines);
  const std::string& today = config_.message_of_the_day;
  if (!today.empty())
    recent.lines.push_back({ChatLineKind::message_of_the_day, 0, "", today, time_of_line(now)});
  if (!recent.lines.empty()) sessions_.send_or_skip(session, encode_message(recent));
}

void ChatRoom::broadcast() {
  ChatLines lines;
  for (ChatEntry& entry : std::exchange(state_.waiting, {})) {
    if (!entry.is_withdrawn) lines.lines.push_back(entry.line);
    state_.add(std::move(entry));
  }
  if (lines.lines.empty()) return;
  std::vector<SessionId> readers;
  for (const Session* session : sessions_.open()) {
    if (reads_chat(*session)) readers.push_back(session->id);
  }
  sessions_.send_to_all(readers, encode_message(lines));
}

std::size_t ChatRoom::withdraw(const PublicKey& key) {
  std::vector<TimeUs> times;
  ChatWithdrawn withdrawn;
  const auto take = [&](ChatEntry& entry) {
    const bool is_meant = entry.line.kind == ChatLineKind::player && entry.key == key;
    if (!is_meant || std::exchange(entry.is_withdrawn, true)) return false;
    times.push_back(entry.line.utc_us);
    return true;
  };
  for (ChatEntry& entry : state_.sent) {
    if (take(entry)) withdrawn.lines.push_back(id_of(entry.line));
  }
  for (ChatEntry& entry : state_.waiting) take(entry);
  if (times.empty()) return 0;
  environment_.withdraw_chat(key, times);
  std::vector<SessionId> readers;
  for (const Session* session : sessions_.open()) {
    if (reads_chat(*session) && session->has(kFeatureChatWithdrawal))
      readers.push_back(session->id);
  }
  if (!withdrawn.lines.empty()) sessions_.send_to_all(readers, encode_message(withdrawn));
  return times.size();
}

}  // namespace runstone
