#include "server/admin/command.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace runstone {
namespace {

constexpr TimeUs kNow = 1'800'000'000'000'000;

template <class Kind>
Kind parsed(const std::string& line) {
  CAPTURE(line);
  const auto command = parse_command(line, kNow);
  INFO((command ? "" : command.error()));
  REQUIRE(command.has_value());
  const auto* kind = std::get_if<Kind>(&*command);
  REQUIRE(kind != nullptr);
  return *kind;
}

std::string mistake(const std::string& line) {
  const auto command = parse_command(line, kNow);
  return command ? "no mistake" : command.error();
}

}  // namespace

TEST_CASE("commands without arguments are parsed", "[admin][command]") {
  parsed<HelpCommand>("help");
  parsed<NamesCommand>("names");
  CHECK(parsed<ReleaseNameCommand>("names release \"the mole\"").name == "the mole");
  parsed<StatusCommand>("  status ");
  parsed<PlayersCommand>("players");
  CHECK(parsed<MaterialsCommand>("materials").part.empty());
  CHECK(parsed<MaterialsCommand>("materials wool").part == "wool");
  CHECK(parsed<MaterialsCommand>("materials add").part == "add");
  CHECK(parsed<AddMaterialsCommand>("materials add \"my wool.toml\"").file == "my wool.toml");
  parsed<ServersCommand>("servers");
  CHECK(parsed<HandoverCommand>("handover").server == std::nullopt);
  CHECK(parsed<HandoverCommand>("handover 17").server == 17U);
  parsed<StopCommand>("stop");
  CHECK_FALSE(parsed<UndoCommand>("undo").is_redo);
  CHECK(parsed<UndoCommand>("redo").is_redo);
  parsed<RollbackListCommand>("rollback list");
}

TEST_CASE("say takes the rest of the line", "[admin][command]") {
  CHECK(parsed<SayCommand>("say hello").text == "hello");
  CHECK(parsed<SayCommand>("  say  restart at 10, don't log off ").text ==
        "restart at 10, don't log off");
  CHECK(parsed<SayCommand>("say \"restart at ten\"").text == "restart at ten");
  CHECK(parsed<SayCommand>("say press \"home\" now").text == "press \"home\" now");
  CHECK(parsed<SayCommand>("say \"a\" and \"b\"").text == "\"a\" and \"b\"");
  CHECK(mistake("say") == "say: the text is refused: it is empty");
  CHECK(mistake("say \" \"") == "say: the text is refused: it is empty");
  CHECK(mistake("say a\xe2\x80\xae"
                "b") == "say: the text is refused: it has invisible characters");
  CHECK(mistake("say " + std::string(513, 'x')) ==
        "say: the text is refused: it has more than 512 bytes");
  CHECK(mistake("say a\nb").starts_with("say: the text is refused: it has control characters"));
  CHECK(mistake("saying") == "\"saying\" is no command: `help` names them");
}

TEST_CASE("chat log selects lines by player, age and number", "[admin][command]") {
  CHECK(parsed<ChatLogCommand>("chat log").query == ChatQuery{});
  const ChatQuery query =
      parsed<ChatLogCommand>("chat log by \"the mole\" since 1h limit 1000").query;
  CHECK(query == ChatQuery{"the mole", kNow - 3'600'000'000, 1'000});
  CHECK(mistake("chat") == "chat: log comes after it, and then by, since or limit");
  CHECK(mistake("chat hello") == "chat: log comes after it, and then by, since or limit");
  CHECK(mistake("chat log of ana") == "chat log \"of\": by, since or limit");
  CHECK(mistake("chat log limit 1001") == "chat log limit \"1001\": a number from 1 to 1000");
  CHECK(mistake("chat log by") == "chat log by: a name, a fingerprint, a key or server is missing");
}

TEST_CASE("a filter selects by author, time, place and cause", "[admin][command]") {
  const auto preview = parsed<RollbackPreviewCommand>(
      "rollback preview author #3 author \"the mole\" since 1h until 2001-09-09T01:46:40Z box 5 60 "
      "-3 -4 70 8 cause player");
  CHECK_FALSE(preview.picture);
  CHECK(parsed<RollbackPreviewCommand>("rollback preview author #3 picture since 1h").picture);
  const CommandFilter& f = preview.filter;
  REQUIRE(f.authors.size() == 2);
  CHECK(f.authors[0] == CommandFilter::Author{"", 3});
  CHECK(f.authors[1] == CommandFilter::Author{"the mole", std::nullopt});
  CHECK(f.from_us == kNow - 3'600'000'000);
  CHECK(f.until_us == 1'000'000'000'000'000);
  CHECK(f.box == VoxelBox{{-4, 60, -3}, {6, 71, 9}});  // both corners inside
  CHECK(f.cause == Cause::player);
  const auto log = parsed<LogCommand>("log");
  CHECK(log.limit == 20);
  CHECK(log.filter == CommandFilter{});
  CHECK(parsed<LogCommand>("log limit 7 cause undo").limit == 7);
}

TEST_CASE("a rollback command takes one id", "[admin][command]") {
  CHECK(parsed<RollbackCommand>("rollback apply p1") ==
        RollbackCommand{RollbackCommand::Verb::apply, "p1"});
  CHECK(parsed<RollbackCommand>("rollback cancel p1") ==
        RollbackCommand{RollbackCommand::Verb::cancel, "p1"});
  CHECK(parsed<RollbackCommand>("rollback undo 9120") ==
        RollbackCommand{RollbackCommand::Verb::undo, "9120"});
}

TEST_CASE("an error names the wrong word and what is allowed", "[admin][command]") {
  CHECK(mistake("") == "no command: `help` names them");
  CHECK(mistake("names free ana") == "names \"free\": release NAME");
  CHECK(mistake("names release the mole") ==
        "names release: one name comes after it, in quotes if it has blanks");
  for (const char* wrong : {"handover ana", "handover -1", "handover 4294967296", "handover 1 2"}) {
    CHECK(mistake(wrong) ==
          "handover: the number of one server comes after it, or nothing (servers lists them)");
  }
  CHECK(mistake("servers all") == "servers \"all\": nothing comes after servers");
  CHECK(mistake("rolback") == "\"rolback\" is no command: `help` names them");
  CHECK(mistake("rollback") == "rollback: preview, apply, cancel, undo or list is missing");
  CHECK(mistake("rollback revert p1") ==
        "rollback \"revert\": preview, apply, cancel, undo or list");
  CHECK(mistake("rollback apply") ==
        "rollback apply: one id comes after it (rollback list names them)");
  CHECK(mistake("rollback list now") == "rollback list \"now\": nothing comes after list");
  CHECK(
      mistake("rollback preview") ==
      "rollback preview: say whose edits, when, where or why: author, since, until, box or cause");
  CHECK(mistake("rollback preview by ana") ==
        "rollback preview \"by\": author, since, until, box, cause or picture");
  CHECK(mistake("rollback preview cause rights") ==
        "rollback preview cause \"rights\": rights undo SEQ takes these records back");
  CHECK(mistake("rollback preview cause materials") ==
        "rollback preview cause \"materials\": added materials stay");
  CHECK(mistake("log since yesterday") ==
        "log since \"yesterday\": how long ago (90s, 15m, 2h30m, 2d, "
        "1w) or when (2026-11-21T23:57:42Z, in UTC)");
  CHECK(mistake("log author #x") == "log author \"#x\": a number after #, or a name");
  CHECK(mistake("log author") == "log author: a name, or # and a number, is missing");
  CHECK(
      mistake("log box 1 2 3 4 5") ==
      "log box: six numbers: x y z of one corner and of the opposite one, both inside is missing");
  CHECK(mistake("log box 1 2 3 4 5 6000000000") ==
        "log box \"6000000000\": a whole number from -536870912 to 536870911");
  CHECK(mistake("log cause rage") ==
        "log cause \"rage\": player, console, rollback, undo, redo, import, rights or materials");
  CHECK(mistake("log limit 0") == "log limit \"0\": a number from 1 to 1000");
  CHECK(mistake("log \"a") == "a \" is missing at the end");
  CHECK(mistake("materials wool red") ==
        "materials \"red\": at most one word comes after materials");
  CHECK(mistake("materials add my wool.toml") ==
        "materials add: one file comes after it, in quotes if it has blanks");
  CHECK(mistake("backup") == "backup: the new folder comes after it");
  CHECK(mistake("reload now") == "reload \"now\": nothing comes after reload");
  CHECK(mistake("undo it") == "undo \"it\": nothing comes after undo");
  CHECK(mistake("help\n") == "a command is printable UTF-8 text");
  CHECK(mistake(std::string(kCommandBytesMax + 1, 'a')) == "a command has at most 1024 bytes");
}

TEST_CASE("answers and filters use the same names of causes", "[admin][command]") {
  for (const Cause cause : {Cause::player, Cause::console, Cause::rollback, Cause::undo,
                            Cause::redo, Cause::import, Cause::rights, Cause::materials}) {
    CHECK(parsed<LogCommand>("log cause " + std::string(name_of(cause))).filter.cause == cause);
  }
}

}  // namespace runstone
