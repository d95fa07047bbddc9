// CommandRow: a command, as a row of the table of commands. The rows stand in files such as
// ground_commands.cpp, each below the function that parses its words and the one that carries it
// out, so a new command is one more row there. command_table.hpp joins the files.
#pragma once
#include <any>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "common/core/result.hpp"
#include "common/rights/right.hpp"
#include "server/admin/operator_actions.hpp"
#include "server/admin/word_reader.hpp"

namespace runstone {

struct CommandCall;
struct CommandRow;

/// A line that was parsed.
struct Command {
  const CommandRow* row = nullptr;
  std::any meaning;           // of the words after those that name the command
  bool is_confirmed = false;  // the line ended with kAnyway
};

/// The word at the end of a line that confirms a command with wide consequences. Without it the
/// command is refused with what it would do.
inline constexpr const char* kAnyway = "anyway";

/// Who may give a command.
struct CommandRule {
  RightSet any_of;        // each of these rights suffices; empty: the command is for everybody
  bool is_local = false;  // for the console and `runstone-server control` only
};
inline constexpr CommandRule kForEverybody;
inline constexpr CommandRule kLocal{{}, true};
template <class... Rights>
constexpr CommandRule needs(Rights... any_of) {
  return {{any_of...}, false};
}

/// A command that came to a server that follows the owner of its world.
struct FollowerCall {
  const OperatorActions& actions;
  std::string status;  // of the server
  CommandReply reply;
};

/// The answer of a server that follows to the other commands.
inline constexpr const char* kGiveThere =
    "this server follows the owner of the world: give the command there";

using ReadPassword = std::function<Result<std::string, std::string>()>;

/// The two functions of a command (parsed_by(), alone()). `parse` uses neither world nor clock:
/// names are not looked up. Its error is one line of text for the person who typed the command.
/// `run` may answer later; the last answer ends the command.
struct CommandFunctions {
  Result<std::any, std::string> (*parse)(WordReader& reader) = nullptr;
  void (*run)(const CommandCall& call, const std::any& meaning) = nullptr;
};

struct CommandRow {
  /// The words with which a line begins: "rollback preview". A word in capitals stands for any word
  /// and FILE for the name of a file, which the control program makes a whole path. Of several rows
  /// that fit a line the one with the most words counts.
  std::string_view words;
  CommandRule rule;
  /// Lines of `help`, without a line break at the end. Empty: an earlier row names this command.
  const char* help = "";
  CommandFunctions functions;

  bool may_be_confirmed = false;  // kAnyway may end the line
  bool takes_text = false;        // the rest of the line is one text, also with single quotes in it
  bool is_secret = false;         // the server's log gets no more than the first word
  /// How a server that follows the owner carries the command out. Null: it refuses the command.
  void (*run_at_follower)(const FollowerCall& call) = nullptr;
  /// Returns the line as the control program sends it. Null: as it was typed.
  Result<std::string, std::string> (*complete)(const std::string& line, const std::any& meaning,
                                               const ReadPassword& read_password) = nullptr;
};

/// Returns the functions of a command. `parse_words` returns a Result of what the words mean, which
/// `carry_out` gets.
template <auto parse_words, auto carry_out>
constexpr CommandFunctions parsed_by() {
  using Meaning = std::remove_cvref_t<decltype(*parse_words(std::declval<WordReader&>()))>;
  return {[](WordReader& reader) -> Result<std::any, std::string> {
            auto meaning = parse_words(reader);
            if (!meaning) return failure(meaning.error());
            return std::any(*std::move(meaning));
          },
          [](const CommandCall& call, const std::any& meaning) {
            carry_out(call, *std::any_cast<Meaning>(&meaning));
          }};
}

/// Returns the functions of a command without further words.
template <auto carry_out>
constexpr CommandFunctions alone() {
  return {[](WordReader& reader) -> Result<std::any, std::string> {
            if (reader.at_end()) return std::any();
            const std::string& name = reader.command();
            return failure(name + " \"" + reader.peek() + "\": nothing comes after " +
                           name.substr(name.rfind(' ') + 1));
          },
          [](const CommandCall& call, const std::any&) { carry_out(call); }};
}

}  // namespace runstone
