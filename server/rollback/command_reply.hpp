// CommandReply: how a command is answered.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace runstone {

struct RestorePreview;

/// One answer: one or more lines of text, without a line break at the end. The last answer to a
/// command has `is_done`.
struct CommandAnswer {
  std::string text;
  bool is_done = true;
  bool is_ok = true;  // of the last answer
  /// The last answer to a preview of a rollback, as far as a client shows it.
  std::shared_ptr<const RestorePreview> restore = nullptr;
  /// An answer that others follow: what the command does is in force, but not on disk yet.
  bool is_unsaved = false;

  /// The last answer, to a command that succeeded or, unless `is_ok`, that did not.
  static CommandAnswer last(std::string text, bool is_ok = true) {
    return {std::move(text), true, is_ok};
  }
  /// An answer that others follow.
  static CommandAnswer progress(std::string text) { return {std::move(text), false, true}; }
  static CommandAnswer unsaved(std::string text) {
    return {std::move(text), false, true, nullptr, true};
  }
};
using CommandReply = std::function<void(const CommandAnswer&)>;

/// Sends the only answer to a command that cannot be carried out.
inline void refuse(const CommandReply& reply, std::string text) {
  reply(CommandAnswer::last(std::move(text), false));
}

}  // namespace runstone
