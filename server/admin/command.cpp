#include "server/admin/command.hpp"

#include <algorithm>
#include <array>

#include "protocol/rules/chat_text.hpp"
#include "server/admin/command_reader.hpp"

namespace runstone {
namespace {

using Words = std::vector<std::string>;

struct CauseName {
  std::string_view name;
  Cause cause;
};
constexpr std::array<CauseName, 8> kCauses = {{{"player", Cause::player},
                                               {"console", Cause::console},
                                               {"rollback", Cause::rollback},
                                               {"undo", Cause::undo},
                                               {"redo", Cause::redo},
                                               {"import", Cause::import},
                                               {"rights", Cause::rights},
                                               {"materials", Cause::materials}}};
constexpr const char* kCauseNames =
    "player, console, rollback, undo, redo, import, rights or materials";

CommandFilter::Author author_of(const std::string& word, CommandReader& reader) {
  if (word.starts_with('#')) {
    const auto number = number_of<AuthorId>(std::string_view(word).substr(1));
    if (!number) reader.wrong("author \"" + word + "\": a number after #, or a name");
    return {"", number};
  }
  return {word, std::nullopt};
}

/// Reads one filter with its values. Returns false if the next word is no filter.
bool take_filter(CommandReader& reader, CommandFilter& filter) {
  const std::string word = reader.peek();
  if (word == "author") {
    reader.take("", "");
    filter.authors.push_back(author_of(reader.take(word, "a name, or # and a number,"), reader));
  } else if (word == "since" || word == "until") {
    reader.take("", "");
    (word == "since" ? filter.from_us : filter.until_us) = reader.moment(word);
  } else if (word == "box") {
    reader.take("", "");
    filter.box = reader.box(word);
  } else if (word == "cause") {
    reader.take("", "");
    const std::string name = reader.take(word, kCauseNames);
    const auto found =
        std::find_if(kCauses.begin(), kCauses.end(), [&](const auto& c) { return c.name == name; });
    if (found != kCauses.end()) filter.cause = found->cause;
    if (found == kCauses.end()) reader.wrong("cause \"" + name + "\": " + kCauseNames);
  } else {
    return false;
  }
  return true;
}

Result<Command, std::string> materials_command(const Words& words) {
  if (words.size() == 1) return Command(MaterialsCommand{});
  if (words.size() == 2) return Command(MaterialsCommand{words[1]});
  if (words[1] != "add")
    return failure("materials \"" + words[2] + "\": at most one word comes after materials");
  if (words.size() != 3)
    return failure("materials add: one file comes after it, in quotes if it has blanks");
  return Command(AddMaterialsCommand{words[2]});
}

Result<Command, std::string> log_command(CommandReader reader) {
  LogCommand log;
  while (!reader.at_end()) {
    if (take_filter(reader, log.filter)) continue;
    const std::string word = reader.take("", "");
    if (word != "limit") {
      return failure("log \"" + word + "\": author, since, until, box, cause or limit");
    }
    const std::string text = reader.take(word, "how many edits");
    const auto number = number_of<std::uint64_t>(text);
    if (!number || *number == 0 || *number > kLogLinesMax) {
      reader.wrong("limit \"" + text + "\": a number from 1 to " + std::to_string(kLogLinesMax));
    } else {
      log.limit = *number;
    }
  }
  if (!reader.error().empty()) return failure("log " + reader.error());
  return Command(log);
}

Result<Command, std::string> chat_command(const Words& words, TimeUs now_us) {
  if (words.size() < 2 || words[1] != "log")
    return failure("chat: log comes after it, and then by, since or limit");
  CommandReader reader(words, 2, now_us);
  ChatQuery query;
  while (!reader.at_end()) {
    const std::string word = reader.take("", "");
    if (word == "by") {
      query.by = reader.take(word, "a name, a fingerprint, a key or server");
    } else if (word == "since") {
      query.since_us = reader.moment(word);
    } else if (word == "limit") {
      query.limit = static_cast<std::uint64_t>(
          reader.number(word, 1, static_cast<std::int64_t>(kChatLinesListedMax)));
    } else {
      return failure("chat log \"" + word + "\": by, since or limit");
    }
  }
  if (!reader.error().empty()) return failure("chat log " + reader.error());
  return Command(ChatLogCommand{std::move(query)});
}

Result<Command, std::string> handover_command(const Words& words) {
  if (words.size() == 1) return Command(HandoverCommand{});
  const auto number = number_of<SessionId>(words[1]);
  if (words.size() != 2 || !number)
    return failure(
        "handover: the number of one server comes after it, or nothing (servers lists them)");
  return Command(HandoverCommand{number});
}

/// Parses what comes after `say`: the rest of the line, also with single quotes in it. A text that is
/// quoted as a whole is taken without its quotes.
Result<Command, std::string> say_command(std::string_view rest) {
  const std::size_t last = rest.find_last_not_of(' ');
  rest = rest.substr(0, last == std::string_view::npos ? 0 : last + 1);
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  const bool is_quoted =
      rest.size() >= 2 && rest.front() == '"' && rest.find('"', 1) == rest.size() - 1;
  if (is_quoted) rest = rest.substr(1, rest.size() - 2);
  auto text = chat_text(rest);
  if (!text) return failure("say: the text is refused: " + text.error());
  return Command(SayCommand{*std::move(text)});
}

Result<Command, std::string> preview_command(CommandReader reader) {
  RollbackPreviewCommand preview;
  while (!reader.at_end()) {
    if (reader.take_word("picture")) {
      preview.picture = true;
      continue;
    }
    if (take_filter(reader, preview.filter)) continue;
    return failure("rollback preview \"" + reader.peek() +
                   "\": author, since, until, box, cause or picture");
  }
  if (!reader.error().empty()) return failure("rollback preview " + reader.error());
  if (preview.filter.cause == Cause::rights)
    return failure("rollback preview cause \"rights\": rights undo SEQ takes these records back");
  if (preview.filter.cause == Cause::materials)
    return failure("rollback preview cause \"materials\": added materials stay");
  // A preview without filters would select the whole world, most likely by mistake.
  if (preview.filter == CommandFilter{}) {
    return failure(
        "rollback preview: say whose edits, when, where or why: author, since, until, "
        "box or cause");
  }
  return Command(preview);
}

Result<Command, std::string> rollback_command(const Words& words, TimeUs now_us) {
  const std::string allowed = "preview, apply, cancel, undo or list";
  if (words.size() < 2) return failure("rollback: " + allowed + " is missing");
  const std::string& verb = words[1];
  if (verb == "preview") return preview_command(CommandReader(words, 2, now_us));
  if (verb == "list") {
    if (words.size() > 2)
      return failure("rollback list \"" + words[2] + "\": nothing comes after list");
    return Command(RollbackListCommand{});
  }
  RollbackCommand command;
  if (verb == "apply") {
    command.verb = RollbackCommand::Verb::apply;
  } else if (verb == "cancel") {
    command.verb = RollbackCommand::Verb::cancel;
  } else if (verb == "undo") {
    command.verb = RollbackCommand::Verb::undo;
  } else {
    return failure("rollback \"" + verb + "\": " + allowed);
  }
  if (words.size() != 3)
    return failure("rollback " + verb + ": one id comes after it (rollback list names them)");
  command.id = words[2];
  return Command(command);
}

}  // namespace

Result<Command, std::string> parse_command(std::string_view line, TimeUs now_us) {
  constexpr std::string_view kSay = "say ";
  const std::string_view begin = line.substr(std::min(line.find_first_not_of(' '), line.size()));
  if (begin.starts_with(kSay)) return say_command(begin.substr(kSay.size()));
  const auto words = command_words(line);
  if (!words) return failure(words.error());
  if (words->empty()) return failure("no command: `help` names them");
  const std::string& name = words->front();
  if (name == "log") return log_command(CommandReader(*words, 1, now_us));
  if (name == "say") return say_command("");
  if (name == "chat") return chat_command(*words, now_us);
  if (name == "rollback") return rollback_command(*words, now_us);
  if (auto rights = parse_rights_command(*words, now_us)) {
    if (!*rights) return failure(rights->error());
    return Command(**std::move(rights));
  }
  if (name == "materials") return materials_command(*words);
  if (name == "handover") return handover_command(*words);
  if (name == "names" && words->size() > 1) {
    if ((*words)[1] != "release") return failure("names \"" + (*words)[1] + "\": release NAME");
    if (words->size() != 3)
      return failure("names release: one name comes after it, in quotes if it has blanks");
    return Command(ReleaseNameCommand{(*words)[2]});
  }
  if (name == "backup") {
    if (words->size() != 2) return failure("backup: the new folder comes after it");
    return Command(BackupCommand{(*words)[1]});
  }
  std::optional<Command> plain;
  if (name == "help") plain = HelpCommand{};
  if (name == "status") plain = StatusCommand{};
  if (name == "players") plain = PlayersCommand{};
  if (name == "names") plain = NamesCommand{};
  if (name == "servers") plain = ServersCommand{};
  if (name == "stop") plain = StopCommand{};
  if (name == "reload") plain = ReloadCommand{};
  if (name == "undo") plain = UndoCommand{false};
  if (name == "redo") plain = UndoCommand{true};
  if (!plain) return failure("\"" + name + "\" is no command: `help` names them");
  if (words->size() > 1)
    return failure(name + " \"" + (*words)[1] + "\": nothing comes after " + name);
  return *plain;
}

std::string_view name_of(Cause cause) {
  const auto found =
      std::find_if(kCauses.begin(), kCauses.end(), [&](const auto& c) { return c.cause == cause; });
  return found == kCauses.end() ? "?" : found->name;
}

}  // namespace runstone
