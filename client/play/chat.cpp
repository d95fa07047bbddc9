#include "client/play/chat.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/core/text.hpp"

namespace runstone {
namespace {

ChatTone tone_of(ChatLineKind kind) {
  switch (kind) {
    case ChatLineKind::player:
      return ChatTone::player;
    case ChatLineKind::refused:
      return ChatTone::refused;
    default:
      return ChatTone::server;
  }
}

/// Returns true if the line gives the command undo.
bool is_undo(std::string_view typed) {
  typed.remove_prefix(1);
  typed.remove_prefix(std::min(typed.find_first_not_of(' '), typed.size()));
  return typed.substr(0, typed.find(' ')) == "undo";
}

}  // namespace

void Chat::send(const std::string& typed) {
  if (typed.find_first_not_of(' ') == std::string::npos) return;
  std::string why;
  if (typed.starts_with('/')) {
    take_answer();  // before the next command takes its place
    if (is_undo(typed) && before_undo_) before_undo_();
    const auto given = session_.command(typed.substr(1));
    is_answer_due_ = is_answer_due_ || given.has_value();
    if (!given) why = given.error().what;
  } else if (const auto sent = session_.chat(typed); !sent) {
    why = sent.error();
  }
  if (!why.empty()) lines_.push_back({"[not sent] " + why, ChatTone::refused});
}

std::vector<ShownLine> Chat::take_lines() {
  take_answer();
  for (const ChatLine& line : session_.drain_chat()) {
    lines_.push_back({printed_line(line), tone_of(line.kind)});
    if (line.kind == ChatLineKind::player) lines_.back().id = id_of(line);
  }
  return std::exchange(lines_, {});
}

void Chat::take_answer() {
  if (!is_answer_due_ || session_.commanding()) return;
  is_answer_due_ = false;
  for (const std::string& line : session_.command_lines())
    lines_.push_back({with_unseen_replaced(line), ChatTone::answer});
}

std::string printed_line(const ChatLine& line) {
  const std::string text = with_unseen_replaced(line.text);
  switch (line.kind) {
    case ChatLineKind::player: {
      // The name "ana> hello <bea" would read as a line of Ana.
      std::string name = line.name;
      std::replace(name.begin(), name.end(), '<', '(');
      std::replace(name.begin(), name.end(), '>', ')');
      return "<" + name + "> " + text;
    }
    case ChatLineKind::server:
      return "[server] " + text;
    case ChatLineKind::message_of_the_day:
      return "[today] " + text;
    case ChatLineKind::refused:
      return "[not sent] " + text;
    case ChatLineKind::visit:
      return "[players] " + text;
  }
  return "[chat] " + text;  // a kind that this client does not know
}

}  // namespace runstone
