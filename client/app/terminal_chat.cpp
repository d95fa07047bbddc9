#include "client/app/terminal_chat.hpp"

#include <algorithm>
#include <cstdio>

namespace runstone {
namespace {

void print(const std::string& line) {
  std::fputs((line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace

TerminalChat::TerminalChat(Chat& chat, std::optional<int> input) : chat_(chat) {
  if (input) input_.emplace(*input);
}

std::vector<ShownLine> TerminalChat::step() {
  if (input_) {
    for (const std::string& typed : input_->take_lines()) chat_.send(typed);
  }
  std::vector<ShownLine> lines = chat_.take_lines();
  for (const ShownLine& line : lines) {
    print(line.text);
    if (line.tone == ChatTone::answer) continue;
    heard_.push_back(line.text);
    if (heard_.size() > kHeardMax) heard_.pop_front();
  }
  return lines;
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
