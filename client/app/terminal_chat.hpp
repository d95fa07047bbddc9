// TerminalChat: the chat of runstone-client in its terminal. Its lines are printed on standard
// output, and lines that the player types are sent. One thread.
#pragma once
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "client/app/line_input.hpp"
#include "client/play/chat.hpp"

namespace runstone {

class TerminalChat {
 public:
  /// The number of printed lines that scripts may wait for. Beyond it the oldest one is dropped.
  static constexpr std::size_t kHeardMax = 256;

  /// `chat` must outlive the object. `input`: the descriptor of the terminal in which the player
  /// types, or nullopt.
  TerminalChat(Chat& chat, std::optional<int> input);

  /// Sends what was typed, and prints what arrived. Returns the printed lines.
  std::vector<ShownLine> step();
  /// Returns true if a printed line contains the text, and then forgets the lines up to it.
  bool take_heard(const std::string& text);

 private:
  Chat& chat_;
  std::optional<LineInput> input_;
  std::deque<std::string> heard_;
};

}  // namespace runstone
