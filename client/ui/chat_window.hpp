// ChatWindow: the chat on the screen. The newest lines are shown for some seconds over the world.
// While the window is open, it has all kept lines and a field to type in. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/ui/chat_completion.hpp"
#include "protocol/codec/chat_messages.hpp"

namespace runstone {

enum class ChatTone : std::uint8_t {
  player,   // a line of a player
  server,   // a line of the host
  refused,  // why a line of this player was not passed on
  answer,   // the answer to a command
};
struct ShownLine {
  std::string text;
  ChatTone tone = ChatTone::player;
  ChatLineId id{};  // of a line of a player; otherwise without a name
};

class ChatWindow {
 public:
  static constexpr std::size_t kEntriesMax = 500;  // kept; beyond it the oldest one is dropped
  static constexpr std::size_t kTypedMax = 50;     // typed lines that the arrow keys bring back
  static constexpr std::size_t kNewestShown = 8;   // while the window is closed
  static constexpr double kShownSeconds = 10, kFadeSeconds = 1.5;

  void hear(ShownLine entry);
  /// Removes these lines. Returns their number.
  std::size_t withdraw(const std::vector<ChatLineId>& lines);
  std::size_t line_count() const { return lines_.size(); }
  /// Sets the names that the tab key completes.
  void set_names(std::vector<std::string> names) { completion_.set_names(std::move(names)); }
  /// Opens the field with a text in it, such as "/".
  void open(std::string text);
  void close();
  bool is_open() const { return is_open_; }
  /// Returns true from open() until the field has the keyboard.
  bool takes_focus() const { return is_open_ && takes_focus_; }
  void advance(double seconds);
  /// Returns true while a closed window shows a line that fades.
  bool is_fading() const;

  /// Makes the window with ImGui, with its lower edge at `bottom` pixels. Returns the line if one
  /// was typed; the window is closed then.
  std::optional<std::string> build(double bottom, double scale);

 private:
  struct Line {
    ShownLine entry;
    double age = 0;  // seconds
  };
  bool shows_newest() const;
  void build_newest(double bottom, double scale) const;
  std::optional<std::string> build_open(double bottom, double scale);
  /// Replaces the text in the field by an older (-1) or newer (+1) typed line.
  const std::string& typed_line(int step);
  friend struct ChatFieldCallback;

  std::deque<Line> lines_;
  std::deque<std::string> typed_;
  std::size_t typed_at_ = 0;  // the typed line in the field; typed_.size(): a new one
  std::string draft_;         // the new line, while an older one is in the field
  std::string field_;
  ChatCompletion completion_;
  bool is_open_ = false, takes_focus_ = false, has_new_line_ = false;
};

}  // namespace runstone
