#include "server/admin/command.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "common/core/text.hpp"
#include "common/core/utc_text.hpp"

namespace runstone {
namespace {

using Words = std::vector<std::string>;

Unexpected<std::string> mistake(std::string line) { return {std::move(line)}; }

Result<Words, std::string> words_of(std::string_view line) {
  if (line.size() > kCommandBytesMax) {
    return mistake("a command has at most " + std::to_string(kCommandBytesMax) + " bytes");
  }
  if (!is_printable_utf8(line)) return mistake("a command is printable UTF-8 text");
  Words words;
  for (std::size_t at = 0; at < line.size();) {
    if (line[at] == ' ') {
      ++at;
      continue;
    }
    const bool is_quoted = line[at] == '"';
    const std::size_t first = is_quoted ? at + 1 : at;
    const std::size_t end = std::min(line.find(is_quoted ? '"' : ' ', first), line.size());
    if (is_quoted && end == line.size()) return mistake("a \" is missing at the end");
    words.emplace_back(line.substr(first, end - first));
    at = end + 1;
  }
  return words;
}

struct CauseName {
  std::string_view name;
  Cause cause;
};
constexpr std::array<CauseName, 6> kCauses = {{{"player", Cause::player},
                                               {"console", Cause::console},
                                               {"rollback", Cause::rollback},
                                               {"undo", Cause::undo},
                                               {"redo", Cause::redo},
                                               {"import", Cause::import}}};

template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Reads the words of a command one after another and keeps the first error.
class Reader {
 public:
  Reader(const Words& words, std::size_t next, TimeUs now_us)
      : words_(words), next_(next), now_us_(now_us) {}

  /// Takes the next word if it is `word`. Returns true if it was.
  bool take_word(std::string_view word) {
    if (at_end() || peek() != word) return false;
    ++next_;
    return true;
  }
  bool at_end() const { return next_ == words_.size() || !error_.empty(); }
  const std::string& peek() const { return words_[next_]; }
  /// Returns the next word. If there is none, returns an empty word and records an error.
  std::string take(const std::string& after, const std::string& what) {
    if (next_ < words_.size()) return words_[next_++];
    wrong(after + ": " + what + " is missing");
    return {};
  }
  void wrong(std::string line) {
    if (error_.empty()) error_ = std::move(line);
  }
  const std::string& error() const { return error_; }

  TimeUs moment(const std::string& word) {
    const std::string text = take(word, kMoment);
    if (const auto ago = parse_duration(text)) return now_us_ - *ago;
    if (const auto at = parse_utc(text)) return *at;
    if (error_.empty()) wrong(word + " \"" + text + "\": " + kMoment);
    return 0;
  }
  std::int32_t coordinate() {
    const std::string text =
        take("box", "six numbers: x y z of one corner and of the opposite one, both inside");
    const auto number = number_of<std::int32_t>(text);
    if (number && *number >= -kWorldLimit && *number < kWorldLimit) return *number;
    wrong("box \"" + text + "\": a whole number from " + std::to_string(-kWorldLimit) + " to " +
          std::to_string(kWorldLimit - 1));
    return 0;
  }

 private:
  static constexpr const char* kMoment =
      "how long ago (90s, 15m, 2h30m, 2d, 1w) or when (2026-11-21T23:57:42Z, in UTC)";
  const Words& words_;
  std::size_t next_;
  TimeUs now_us_;
  std::string error_;
};

CommandFilter::Author author_of(const std::string& word, Reader& reader) {
  if (word.starts_with('#')) {
    const auto number = number_of<AuthorId>(std::string_view(word).substr(1));
    if (!number) reader.wrong("author \"" + word + "\": a number after #, or a name");
    return {"", number};
  }
  return {word, std::nullopt};
}

/// Reads one filter with its values. Returns false if the next word is no filter.
bool take_filter(Reader& reader, CommandFilter& filter) {
  const std::string word = reader.peek();
  if (word == "author") {
    reader.take("", "");
    filter.authors.push_back(author_of(reader.take(word, "a name, or # and a number,"), reader));
  } else if (word == "since" || word == "until") {
    reader.take("", "");
    (word == "since" ? filter.from_us : filter.until_us) = reader.moment(word);
  } else if (word == "box") {
    reader.take("", "");
    std::array<std::int32_t, 6> c{};
    for (std::int32_t& number : c) number = reader.coordinate();
    filter.box =
        VoxelBox{{std::min(c[0], c[3]), std::min(c[1], c[4]), std::min(c[2], c[5])},
                 {std::max(c[0], c[3]) + 1, std::max(c[1], c[4]) + 1, std::max(c[2], c[5]) + 1}};
  } else if (word == "cause") {
    reader.take("", "");
    const std::string name = reader.take(word, "player, console, rollback, undo, redo or import");
    const auto found =
        std::find_if(kCauses.begin(), kCauses.end(), [&](const auto& c) { return c.name == name; });
    if (found != kCauses.end()) filter.cause = found->cause;
    if (found == kCauses.end()) {
      reader.wrong("cause \"" + name + "\": player, console, rollback, undo, redo or import");
    }
  } else {
    return false;
  }
  return true;
}

Result<Command, std::string> log_command(Reader reader) {
  LogCommand log;
  while (!reader.at_end()) {
    if (take_filter(reader, log.filter)) continue;
    const std::string word = reader.take("", "");
    if (word != "limit") {
      return mistake("log \"" + word + "\": author, since, until, box, cause or limit");
    }
    const std::string text = reader.take(word, "how many edits");
    const auto number = number_of<std::uint64_t>(text);
    if (!number || *number == 0 || *number > kLogLinesMax) {
      reader.wrong("limit \"" + text + "\": a number from 1 to " + std::to_string(kLogLinesMax));
    } else {
      log.limit = *number;
    }
  }
  if (!reader.error().empty()) return mistake("log " + reader.error());
  return Command(log);
}

Result<Command, std::string> preview_command(Reader reader) {
  RollbackPreviewCommand preview;
  while (!reader.at_end()) {
    if (reader.take_word("picture")) {
      preview.picture = true;
      continue;
    }
    if (take_filter(reader, preview.filter)) continue;
    return mistake("rollback preview \"" + reader.peek() +
                   "\": author, since, until, box, cause or picture");
  }
  if (!reader.error().empty()) return mistake("rollback preview " + reader.error());
  // A preview without filters would select the whole world, most likely by mistake.
  if (preview.filter == CommandFilter{}) {
    return mistake(
        "rollback preview: say whose edits, when, where or why: author, since, until, "
        "box or cause");
  }
  return Command(preview);
}

Result<Command, std::string> rollback_command(const Words& words, TimeUs now_us) {
  const std::string allowed = "preview, apply, cancel, undo or list";
  if (words.size() < 2) return mistake("rollback: " + allowed + " is missing");
  const std::string& verb = words[1];
  if (verb == "preview") return preview_command(Reader(words, 2, now_us));
  if (verb == "list") {
    if (words.size() > 2)
      return mistake("rollback list \"" + words[2] + "\": nothing comes after list");
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
    return mistake("rollback \"" + verb + "\": " + allowed);
  }
  if (words.size() != 3)
    return mistake("rollback " + verb + ": one id comes after it (rollback list names them)");
  command.id = words[2];
  return Command(command);
}

}  // namespace

Result<Command, std::string> parse_command(std::string_view line, TimeUs now_us) {
  const auto words = words_of(line);
  if (!words) return mistake(words.error());
  if (words->empty()) return mistake("no command: `help` names them");
  const std::string& name = words->front();
  if (name == "log") return log_command(Reader(*words, 1, now_us));
  if (name == "rollback") return rollback_command(*words, now_us);
  if (name == "materials") {
    if (words->size() > 2) {
      return mistake("materials \"" + (*words)[2] + "\": at most one word comes after materials");
    }
    return Command(MaterialsCommand{words->size() == 2 ? (*words)[1] : std::string()});
  }
  if (name == "names" && words->size() > 1) {
    if ((*words)[1] != "release") return mistake("names \"" + (*words)[1] + "\": release NAME");
    if (words->size() != 3)
      return mistake("names release: one name comes after it, in quotes if it has blanks");
    return Command(ReleaseNameCommand{(*words)[2]});
  }
  if (name == "backup") {
    if (words->size() != 2) return mistake("backup: the new folder comes after it");
    return Command(BackupCommand{(*words)[1]});
  }
  std::optional<Command> plain;
  if (name == "help") plain = HelpCommand{};
  if (name == "status") plain = StatusCommand{};
  if (name == "players") plain = PlayersCommand{};
  if (name == "names") plain = NamesCommand{};
  if (name == "stop") plain = StopCommand{};
  if (name == "reload") plain = ReloadCommand{};
  if (name == "undo") plain = UndoCommand{false};
  if (name == "redo") plain = UndoCommand{true};
  if (!plain) return mistake("\"" + name + "\" is no command: `help` names them");
  if (words->size() > 1)
    return mistake(name + " \"" + (*words)[1] + "\": nothing comes after " + name);
  return *plain;
}

bool is_for_everybody(const Command& command) {
  return std::holds_alternative<HelpCommand>(command) ||
         std::holds_alternative<MaterialsCommand>(command) ||
         std::holds_alternative<UndoCommand>(command);
}

std::string command_help(bool is_operator) {
  std::string text =
      "help                      this list\n"
      "materials [PART]          the materials of this world; "
      "with PART those whose name contains it\n"
      "undo                      take back your last edit; what others built there since stays\n"
      "redo                      do again what you undid last";
  if (!is_operator) return text;
  return text +
         "\nstatus                    what the server does\n"
         "players                   who is here, who has ever built, "
         "and who else was here since the server started\n"
         "log FILTERS [limit N]     the newest edits, the last one at the bottom\n"
         "names                     which key owns which name\n"
         "names release NAME        free a name, so that the next player who joins under it owns "
         "it\n"
         "rollback preview FILTERS [picture]\n"
         "                          what a rollback of these edits would do; "
         "`picture` draws the area before and after\n"
         "rollback apply ID         do it, while people go on playing; "
         "what others built since stays\n"
         "rollback cancel ID        stop it, or forget a preview\n"
         "rollback undo ID          take a rollback back\n"
         "rollback list             previews, and the rollbacks so far\n"
         "backup DIR                copy the world to a new folder, while people go on playing\n"
         "reload                    read the settings again\n"
         "stop                      stop the server\n"
         "FILTERS, any of: author NAME or author #N (several: any of them), "
         "since 1h or since 2026-11-21T23:57:42Z,\n"
         "  until likewise, box X Y Z X Y Z, cause player|console|rollback|undo|redo|import";
}

std::string_view name_of(Cause cause) {
  const auto found =
      std::find_if(kCauses.begin(), kCauses.end(), [&](const auto& c) { return c.cause == cause; });
  return found == kCauses.end() ? "?" : found->name;
}

}  // namespace runstone
