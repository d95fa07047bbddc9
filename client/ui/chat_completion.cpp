#include "client/ui/chat_completion.hpp"

#include <algorithm>
#include <array>

namespace runstone {
namespace {

using namespace std::string_view_literals;

constexpr std::array kCommands = {"activity"sv,
                                  "announce"sv,
                                  "announcements"sv,
                                  "announcements remove"sv,
                                  "ban"sv,
                                  "bans"sv,
                                  "builds cancel"sv,
                                  "builds list"sv,
                                  "builds place"sv,
                                  "builds remove"sv,
                                  "builds show"sv,
                                  "chat log"sv,
                                  "chat withdraw"sv,
                                  "claim"sv,
                                  "clock"sv,
                                  "clock correct"sv,
                                  "freeze"sv,
                                  "grant"sv,
                                  "grants"sv,
                                  "handover"sv,
                                  "help"sv,
                                  "invite"sv,
                                  "invite cancel"sv,
                                  "invites"sv,
                                  "kick"sv,
                                  "log"sv,
                                  "materials"sv,
                                  "mute"sv,
                                  "names"sv,
                                  "names release"sv,
                                  "page list"sv,
                                  "page revoke"sv,
                                  "password"sv,
                                  "password clear"sv,
                                  "players"sv,
                                  "protect"sv,
                                  "protected"sv,
                                  "redo"sv,
                                  "refusals"sv,
                                  "report"sv,
                                  "reports"sv,
                                  "reports close"sv,
                                  "retention"sv,
                                  "retention preview"sv,
                                  "revoke"sv,
                                  "rights undo"sv,
                                  "role default"sv,
                                  "role remove"sv,
                                  "role set"sv,
                                  "roles"sv,
                                  "rollback apply"sv,
                                  "rollback cancel"sv,
                                  "rollback list"sv,
                                  "rollback preview"sv,
                                  "rollback undo"sv,
                                  "say"sv,
                                  "servers"sv,
                                  "spawn"sv,
                                  "spawn here"sv,
                                  "spawn keep-clear"sv,
                                  "status"sv,
                                  "stop"sv,
                                  "time"sv,
                                  "time rate"sv,
                                  "unban"sv,
                                  "undo"sv,
                                  "unfreeze"sv,
                                  "unmute"sv,
                                  "unprotect"sv,
                                  "why"sv};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool begins_with(std::string_view text, std::string_view start) {
  return text.size() >= start.size() &&
         std::equal(start.begin(), start.end(), text.begin(),
                    [](char a, char b) { return lower(a) == lower(b); });
}

bool is_command(std::string_view line) { return line.starts_with('/'); }

/// Returns where the word begins that ends at the end of the text. An open quote begins one.
std::size_t word_begin(std::string_view text) {
  if (is_command(text) && std::count(text.begin(), text.end(), '"') % 2 != 0)
    return text.rfind('"');
  const std::size_t blank = text.rfind(' ');
  return blank == std::string_view::npos ? 0 : blank + 1;
}

std::string as_word(const std::string& name, bool is_in_command) {
  return is_in_command && name.find(' ') != std::string::npos ? "\"" + name + "\"" : name;
}

}  // namespace

std::span<const std::string_view> completed_commands() { return kCommands; }

/// Returns the words that may stand for the end of the text `before` the cursor, from from_ on.
std::vector<std::string> ChatCompletion::candidates(std::string_view before) const {
  std::vector<std::string> out;
  if (is_command(before) && from_ == 0) {
    for (const std::string_view command : kCommands) {
      if (begins_with(command, before.substr(1))) out.push_back("/" + std::string(command));
    }
    return out;
  }
  std::string_view start = before.substr(from_);
  if (start.starts_with('"')) start.remove_prefix(1);
  for (const std::string& name : names_) {
    if (begins_with(name, start)) out.push_back(as_word(name, is_command(before)));
  }
  return out;
}

ChatCompletion::Line ChatCompletion::complete(const Line& line) {
  if (line != given_ || fitting_.empty()) {
    const std::string before = line.text.substr(0, line.cursor);
    rest_ = line.text.substr(line.cursor);
    next_ = 0;
    // A command may have two words, so its name is completed from the slash on if that fits.
    from_ = 0;
    fitting_ = is_command(before) ? candidates(before) : std::vector<std::string>();
    if (fitting_.empty()) {
      from_ = word_begin(before);
      fitting_ = from_ == 0 && is_command(before) ? fitting_ : candidates(before);
    }
    if (fitting_.empty()) return line;
    given_.text = before;
  }
  const std::string& word = fitting_[next_];
  next_ = (next_ + 1) % fitting_.size();
  given_.text = given_.text.substr(0, from_) + word + (rest_.starts_with(' ') ? "" : " ");
  given_.cursor = given_.text.size();
  given_.text += rest_;
  return given_;
}

}  // namespace runstone
