// Chat: the lines that a player sends and reads. A line that begins with a slash is a command for
// the server. One thread.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "client/session/client_session.hpp"
#include "client/ui/chat_window.hpp"

namespace runstone {

class Chat {
 public:
  /// `session` must outlive the object. `before_undo` is called before the command undo is sent; it
  /// may be empty.
  explicit Chat(ClientSession& session, std::function<void()> before_undo = {})
      : session_(session), before_undo_(std::move(before_undo)) {}

  /// Sends a line, or gives a command. If it cannot be sent, a line says why. Does nothing for a
  /// blank line.
  void send(const std::string& typed);
  /// Returns the lines since the last call, which are:
  ///   - the output of commands of send() that are complete;
  ///   - why lines could not be sent;
  ///   - what others and the server wrote.
  std::vector<ShownLine> take_lines();
  /// Returns the lines that the server withdrew since the last call. Hide them after the lines of
  /// take_lines() are shown.
  std::vector<ChatLineId> take_withdrawn() { return session_.take_withdrawn_chat(); }

 private:
  void take_answer();

  ClientSession& session_;
  std::function<void()> before_undo_;
  std::vector<ShownLine> lines_;  // until take_lines()
  bool is_answer_due_ = false;    // of a command that was sent
};

/// Returns a line as it is printed: "<ana> hello", "[server] ...", "[today] ..." for the message of
/// the day, "[players] ..." for one who joined or left, or "[not sent] ..." with the reason why a
/// line of this client was not passed on. Only a line of a player begins with "<", and it begins
/// with the player's name. Characters that with_unseen_replaced() replaces are question marks.
/// Pure.
std::string printed_line(const ChatLine& line);

}  // namespace runstone
