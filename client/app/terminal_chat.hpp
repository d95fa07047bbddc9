// TerminalChat: the chat of runstone-client in its terminal. Lines of players and of the server are
// printed on standard output. Lines that the player types are sent; a line that begins with a slash
// is a command for the server. One thread.
#pragma once
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "client/app/line_input.hpp"
#include "client/session/client_session.hpp"
#include "client/ui/chat_window.hpp"

namespace runstone {

class TerminalChat {
 public:
  /// The number of printed lines that scripts may wait for. Beyond it the oldest one is dropped.
  static constexpr std::size_t kHeardMax = 256;

  /// `session` must outlive the object. `input`: the descriptor of the terminal in which the player
  /// types, or nullopt.
  TerminalChat(ClientSession& session, std::optional<int> input);

  /// Sends what was typed, and prints what arrived.
  void step();
  /// Sends a line, or gives a command if it begins with a slash. If it cannot be sent, a line says
  /// why.
  void send(const std::string& typed);
  /// Returns the lines that were printed since the last call, kHeardMax at most.
  std::vector<ShownLine> take_shown();
  /// Returns true if a printed line contains the text, and then forgets the lines up to it.
  bool take_heard(const std::string& text);

 private:
  void show(ShownLine entry);

  ClientSession& session_;
  std::optional<LineInput> input_;
  std::deque<std::string> heard_;
  std::deque<ShownLine> shown_;
  bool is_answer_due_ = false;  // of a command that was typed
};

}  // namespace runstone
