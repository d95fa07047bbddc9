// CommandReply: how RollbackService and CommandHandler answer a command.
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
};
using CommandReply = std::function<void(const CommandAnswer&)>;

/// Sends the only answer to a command that cannot be carried out.
inline void refuse(const CommandReply& reply, std::string text) {
  reply({std::move(text), true, false});
}

}  // namespace runstone
