// Command: one line of the console, of `runstone-server control` or of a client, as a value.
// Parsing uses neither world nor clock: names are not looked up, and the current time is an
// argument. An error names the wrong word and lists what is allowed in its place.
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
#include "server/admin/rights_command.hpp"
#include "server/chat/chat_query.hpp"

namespace runstone {

/// Selects edits by author, time, place and cause. A field that is not set selects all edits.
struct CommandFilter {
  /// A player, by name or by author number ("#3").
  struct Author {
    std::string name;  // empty: by number
    std::optional<AuthorId> number;
    friend bool operator==(const Author&, const Author&) = default;
  };
  std::vector<Author> authors;              // edits of any of them; empty: of everybody
  std::optional<TimeUs> from_us, until_us;  // UTC, both included
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
struct MaterialsCommand {
  std::string part;  // lists the names that contain it; empty: all
  friend bool operator==(const MaterialsCommand&, const MaterialsCommand&) = default;
};
struct AddMaterialsCommand {
  std::string file;
  friend bool operator==(const AddMaterialsCommand&, const AddMaterialsCommand&) = default;
};
struct ReloadCommand {
  friend bool operator==(const ReloadCommand&, const ReloadCommand&) = default;
};
struct BackupCommand {
  std::string folder;  // the new one
  friend bool operator==(const BackupCommand&, const BackupCommand&) = default;
};
struct ServersCommand {
  friend bool operator==(const ServersCommand&, const ServersCommand&) = default;
};
struct HandoverCommand {
  std::optional<SessionId> server;  // its number; nullopt: the one with the most players
  friend bool operator==(const HandoverCommand&, const HandoverCommand&) = default;
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
struct NamesCommand {
  friend bool operator==(const NamesCommand&, const NamesCommand&) = default;
};
struct ReleaseNameCommand {
  std::string name;
  friend bool operator==(const ReleaseNameCommand&, const ReleaseNameCommand&) = default;
};
struct SayCommand {
  std::string text;  // a chat_text()
  friend bool operator==(const SayCommand&, const SayCommand&) = default;
};
struct ChatLogCommand {
  ChatQuery query;
  friend bool operator==(const ChatLogCommand&, const ChatLogCommand&) = default;
};
struct RollbackPreviewCommand {
  CommandFilter filter;
  bool picture = false;  // draw the area before and after the rollback
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

using Command = std::variant<HelpCommand, StatusCommand, PlayersCommand, MaterialsCommand,
                             AddMaterialsCommand, ServersCommand, HandoverCommand, StopCommand,
                             ReloadCommand, BackupCommand, UndoCommand, LogCommand, NamesCommand,
                             ReleaseNameCommand, SayCommand, ChatLogCommand, RollbackPreviewCommand,
                             RollbackCommand, RollbackListCommand, RightsCommand>;

/// Parses one line without its line break, of at most kCommandBytesMax bytes. Blanks separate
/// words; a word that contains blanks stands in double quotes. `now_us` (UTC) is the time to which
/// ages such as "since 1h" refer. The error is one line of text for the person who typed the
/// command.
Result<Command, std::string> parse_command(std::string_view line, TimeUs now_us);

/// Returns the name that filters and answers use: "player", "rollback", ...
std::string_view name_of(Cause cause);

}  // namespace runstone
