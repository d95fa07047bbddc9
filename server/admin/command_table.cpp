#include "server/admin/command_table.hpp"

#include <algorithm>
#include <cstddef>

#include "server/admin/activity_commands.hpp"
#include "server/admin/allow_commands.hpp"
#include "server/admin/clock_commands.hpp"
#include "server/admin/ground_commands.hpp"
#include "server/admin/host_commands.hpp"
#include "server/admin/library_commands.hpp"
#include "server/admin/moderation_commands.hpp"
#include "server/admin/page_commands.hpp"
#include "server/admin/password_commands.hpp"
#include "server/admin/player_commands.hpp"
#include "server/admin/report_commands.hpp"
#include "server/admin/restore_box_commands.hpp"
#include "server/admin/retention_commands.hpp"
#include "server/admin/role_commands.hpp"
#include "server/admin/rollback_commands.hpp"
#include "server/admin/shape_commands.hpp"
#include "server/admin/spawn_commands.hpp"
#include "server/admin/texture_commands.hpp"
#include "server/admin/time_commands.hpp"

namespace runstone {
namespace {

constexpr const char* kPlayerHelp = "PLAYER: a name, #N, a fingerprint, or a key of 64 hex digits";
constexpr const char* kBoxHelp =
    "BOX: X Y Z X Y Z, two opposite corners, both inside; or columns X Z X Z, from the bottom to "
    "the top";
constexpr const char* kFilterHelp =
    "FILTERS, any of: author NAME, author #N or author NA* (several: any of them), not author NAME,\n"
    "  address-of NAME, joined-after 2d, "
    "since 1h or since 2026-11-21T23:57:42Z,\n"
    "  until 1h or until 2026-11-21T23:57:42Z, box X Y Z X Y Z, in NAME (of a protected box),\n"
    "  cause player|console|rollback|undo|redo|import|rights|materials|library|clock|textures|gap";

bool may_give(const CommandRule& rule, const std::function<bool(Right)>& has_right, bool is_local) {
  if (rule.is_local) return is_local;
  if (rule.any_of == RightSet()) return true;
  for (std::size_t i = 0; i < kRightCount; ++i) {
    const auto right = static_cast<Right>(i);
    if (rule.any_of.has(right) && has_right(right)) return true;
  }
  return false;
}

/// Takes the first word of words that single blanks separate.
std::string_view take_first(std::string_view& words) {
  const std::string_view first = words.substr(0, words.find(' '));
  words.remove_prefix(std::min(first.size() + 1, words.size()));
  return first;
}

bool is_any_word(std::string_view word) { return word[0] >= 'A' && word[0] <= 'Z'; }

/// Returns how many words of a line name the row's command before the first word in capitals.
std::size_t naming_words(const CommandRow& row) {
  std::size_t count = 0;
  for (std::string_view rest = row.words; !rest.empty() && !is_any_word(take_first(rest));) ++count;
  return count;
}

/// Returns how many words of the line the row has, or 0 if the row does not fit the line.
std::size_t fitting_words(const CommandRow& row, const std::vector<std::string>& words) {
  std::size_t count = 0;
  for (std::string_view rest = row.words; !rest.empty(); ++count) {
    const std::string_view word = take_first(rest);
    if (count == words.size() || (!is_any_word(word) && word != words[count])) return 0;
  }
  return count;
}

/// Returns the error about a line that fits no row. If commands begin with its first word, the
/// error lists the words that may come second.
std::string no_command(const std::vector<std::string>& words) {
  const std::string& name = words.front();
  std::vector<std::string> seconds;
  for (const CommandRow& row : command_table()) {
    std::string_view rest = row.words;
    if (take_first(rest) == name) seconds.emplace_back(take_first(rest));
  }
  if (seconds.empty()) return "\"" + name + "\" is no command: `help` names them";
  std::string list = seconds.front();
  for (std::size_t i = 1; i < seconds.size(); ++i)
    list += (i + 1 == seconds.size() ? " or " : ", ") + seconds[i];
  if (words.size() == 1) return name + ": " + list + " is missing";
  return name + " \"" + words[1] + "\": " + list;
}

Result<Command, std::string> parse_words(const CommandRow& row, WordReader reader) {
  auto meaning = row.functions.parse(reader);
  if (!meaning) return failure(meaning.error());
  return Command{&row, *std::move(meaning)};
}

/// Returns true if the last word of the line confirms the command. It does not where it is the first
/// word behind those that name the command, the text of a reason, or the name of an owner or an
/// author.
bool ends_with_anyway(const CommandRow& row, const std::vector<std::string>& words) {
  if (!row.may_be_confirmed || words.size() <= naming_words(row) + 1 || words.back() != kAnyway)
    return false;
  const std::string& before = words[words.size() - 2];
  const bool is_of_log = row.words == "rollback preview";
  return before != "reason" && before != "owner" &&
         !(is_of_log && (before == "author" || before == "address-of"));
}

/// Returns the row of a line that is a word and a text, or null. `text` becomes the text.
const CommandRow* find_text_command(std::string_view line, std::string_view& text) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  for (const CommandRow& row : command_table()) {
    if (!row.takes_text || !line.starts_with(std::string(row.words) + " ")) continue;
    text = line.substr(row.words.size() + 1);
    return &row;
  }
  return nullptr;
}

}  // namespace

const std::vector<CommandRow>& command_table() {
  static const std::vector<CommandRow> table = [] {
    std::vector<CommandRow> rows;
    for (const auto& part :
         {player_commands(), ground_commands(), spawn_commands(), moderation_commands(),
          activity_commands(), report_commands(), rollback_commands(), restore_box_commands(),
          role_commands(), allow_commands(), password_commands(), clock_commands(),
          library_commands(), shape_commands(), texture_commands(), time_commands(),
          retention_commands(), page_commands(), host_commands()})
      rows.insert(rows.end(), part.begin(), part.end());
    return rows;
  }();
  return table;
}

const CommandRow* find_command(const std::vector<std::string>& words) {
  const CommandRow* found = nullptr;
  std::size_t most = 0;
  for (const CommandRow& row : command_table()) {
    const std::size_t count = fitting_words(row, words);
    if (count <= most) continue;
    most = count;
    found = &row;
  }
  return found;
}

Result<Command, std::string> parse_command(std::string_view line, TimeUs now_us) {
  std::string_view text;
  if (const CommandRow* row = find_text_command(line, text)) {
    const std::vector<std::string> name{std::string(row->words)};
    return parse_words(*row, WordReader(name, 1, now_us, text));
  }
  auto words = command_words(line);
  if (!words) return failure(words.error());
  if (words->empty()) return failure("no command: `help` names them");
  const CommandRow* row = find_command(*words);
  if (row == nullptr) return failure(no_command(*words));
  const bool is_confirmed = ends_with_anyway(*row, *words);
  if (is_confirmed) words->pop_back();
  auto command = parse_words(*row, WordReader(*words, naming_words(*row), now_us));
  if (command) command->is_confirmed = is_confirmed;
  return command;
}

std::string command_help(const std::function<bool(Right)>& has_right, bool is_local) {
  std::string text;
  for (const CommandRow& row : command_table()) {
    const bool has_line = *row.help != '\0';
    if (has_line && may_give(row.rule, has_right, is_local)) text += std::string(row.help) + "\n";
  }
  text += kPlayerHelp;
  if (has_right(Right::claim) || has_right(Right::protect)) text += std::string("\n") + kBoxHelp;
  if (has_right(Right::roll_back)) text += std::string("\n") + kFilterHelp;
  return text;
}

std::string logged_command(const std::string& line) {
  const std::string_view begin =
      std::string_view(line).substr(std::min(line.find_first_not_of(" \""), line.size()));
  for (const CommandRow& row : command_table()) {
    std::string_view rest = row.words;
    const std::string word(take_first(rest));
    if (row.is_secret && begin.starts_with(word)) return word + " ...";
  }
  return line;
}

void give_command(const CommandCall& call, const std::string& line) {
  // Ages refer to the time of the log, and restrictions end by it. The command may come before the
  // first commit.
  call.world().changes().read_clocks(call.now);
  const auto command = parse_command(line, call.rights_time());
  if (!command) return call.refuse(command.error());
  if (auto why = why_not(call.caller, call.rights(), command->row->rule, call.rights_time()))
    return call.refuse(*std::move(why));
  CommandCall given = call;
  given.line = line;
  given.is_confirmed = command->is_confirmed;
  command->row->functions.run(given, command->meaning);
}

void give_command(const FollowerCall& call, const std::string& line) {
  const auto words = command_words(line);
  if (!words) return refuse(call.reply, words.error());
  const CommandRow* row = find_command(*words);
  const bool is_alone = row != nullptr && words->size() == naming_words(*row);
  if (!is_alone || row->run_at_follower == nullptr) return refuse(call.reply, kGiveThere);
  row->run_at_follower(call);
}

}  // namespace runstone
