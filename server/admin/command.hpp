// Command: one line of the console, of `runstone-server control` or of a client, as a value. Parsing knows
// neither world nor clock: names stay names, and the time now is an argument. A mistake is answered with the
// word that is wrong and what is allowed in its place.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "protocol/limits.hpp"

namespace runstone {

/// Whose edits, when, where and why; what is left open asks for everything.
struct CommandFilter {
  /// A player, by name or by author number ("#3").
  struct Author {
    std::string name;  // empty: by number
    std::optional<AuthorId> number;
    friend bool operator==(const Author&, const Author&) = default;
  };
  std::vector<Author> authors;              // any of them
  std::optional<TimeUs> from_us, until_us;  // UTC, included
  std::optional<VoxelBox> box;
  std::optional<Cause> cause;
  friend bool operator==(const CommandFilter&, const CommandFilter&) = default;
};

struct HelpCommand {
  friend bool operator==(const HelpCommand&, const HelpCommand&) = default;
};
struct StatusCommand {
  friend bool operator==(const StatusCommand&, const StatusCommand&) = default;
};
struct PlayersCommand {
  friend bool operator==(const PlayersCommand&, const PlayersCommand&) = default;
};
struct StopCommand {
  friend bool operator==(const StopCommand&, const StopCommand&) = default;
};
struct UndoCommand {
  bool is_redo = false;
  friend bool operator==(const UndoCommand&, const UndoCommand&) = default;
};
inline constexpr std::uint64_t kLogLinesMax = 1000;
struct LogCommand {
  CommandFilter filter;
  std::uint64_t limit = 20;  // newest edits, 1 .. kLogLinesMax
  friend bool operator==(const LogCommand&, const LogCommand&) = default;
};
struct RollbackPreviewCommand {
  CommandFilter filter;
  bool picture = false;  // draw the area, before and after
  friend bool operator==(const RollbackPreviewCommand&, const RollbackPreviewCommand&) = default;
};
struct RollbackCommand {
  enum class Verb { apply, cancel, undo } verb{};
  std::string id;
  friend bool operator==(const RollbackCommand&, const RollbackCommand&) = default;
};
struct RollbackListCommand {
  friend bool operator==(const RollbackListCommand&, const RollbackListCommand&) = default;
};

using Command =
    std::variant<HelpCommand, StatusCommand, PlayersCommand, StopCommand, UndoCommand, LogCommand,
                 RollbackPreviewCommand, RollbackCommand, RollbackListCommand>;

/// One line without its line break, kCommandBytesMax at most. Words are parted by blanks; a word with blanks in it stands in double
/// quotes. `now_us`: UTC, what "since 1h" counts from. The error is one line for whoever typed it.
Result<Command, std::string> parse_command(std::string_view line, TimeUs now_us);

/// Whether every player may give it; the others are for operators.
bool is_for_everybody(const Command& command);

/// The commands, one a line: for everybody, or all of them.
std::string command_help(bool is_operator);

/// As filters and answers spell it: "player", "rollback", ...
std::string_view name_of(Cause cause);

}  // namespace runstone
