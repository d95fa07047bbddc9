#include "client/app/terminal_chat.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <utility>

#include "client/play/printed_line.hpp"
#include "common/core/text.hpp"

namespace runstone {
namespace {

void print(const std::string& line) {
  std::fputs((line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

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

}  // namespace

TerminalChat::TerminalChat(ClientSession& session, std::optional<int> input) : session_(session) {
  if (input) input_.emplace(*input);
}

void TerminalChat::step() {
  if (is_answer_due_ && !session_.commanding()) {  // before the next command takes its place
    is_answer_due_ = false;
    for (const std::string& line : session_.command_lines())
      show({with_unseen_replaced(line), ChatTone::answer});
  }
  if (input_) {
    for (const std::string& typed : input_->take_lines()) send(typed);
  }
  for (const ChatLine& line : session_.drain_chat()) {
    heard_.push_back(printed_line(line));
    if (heard_.size() > kHeardMax) heard_.pop_front();
    show({heard_.back(), tone_of(line.kind)});
  }
}

void TerminalChat::show(ShownLine entry) {
  print(entry.text);
  shown_.push_back(std::move(entry));
  if (shown_.size() > kHeardMax) shown_.pop_front();
}

std::vector<ShownLine> TerminalChat::take_shown() {
  std::vector<ShownLine> out(std::make_move_iterator(shown_.begin()),
                             std::make_move_iterator(shown_.end()));
  shown_.clear();
  return out;
}

void TerminalChat::send(const std::string& typed) {
  if (typed.find_first_not_of(' ') == std::string::npos) return;
  std::string why;
  if (typed.starts_with('/')) {
    const auto given = session_.command(typed.substr(1));
    is_answer_due_ = is_answer_due_ || given.has_value();
    if (!given) why = given.error().what;
  } else if (const auto sent = session_.chat(typed); !sent) {
    why = sent.error();
  }
  if (!why.empty()) show({"[not sent] " + why, ChatTone::refused});
}

bool TerminalChat::take_heard(const std::string& text) {
  const auto found = std::find_if(heard_.begin(), heard_.end(), [&](const std::string& line) {
    return line.find(text) != std::string::npos;
  });
  if (found == heard_.end()) return false;
  heard_.erase(heard_.begin(), found + 1);
  return true;
}

}  // namespace runstone
