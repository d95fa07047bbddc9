#include "server/app/server_options.hpp"

#include <catch2/catch.hpp>
#include <iostream>
#include <sstream>
#include <vector>

using namespace runstone;

namespace {

ParsedServerOptions parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "runstone-server");
  return parse_server_options(static_cast<int>(arguments.size()), arguments.data());
}

}  // namespace

TEST_CASE("the last one of two equal flags wins", "[server_options]") {
  const auto parsed =
      parse({"--world", "/world", "--listen", "0.0.0.0:4747", "--listen", "127.0.0.1:5000"});
  REQUIRE(parsed.options);
  CHECK(parsed.options->settings.at("listen") == "127.0.0.1:5000");
  CHECK(parsed.options->settings.at("world") == "/world");

  const auto import = parse({"import", "--luanti", "a", "--world", "b", "--world", "c"});
  REQUIRE(import.options);
  REQUIRE(import.options->import);
  CHECK(import.options->import->world == "c");
}

TEST_CASE("an import names its kind and source, and the place of a file", "[server_options]") {
  const auto file = parse({"import", "file", "castle.schem", "--world", "w", "--at", "-10,20,30"});
  REQUIRE(file.options);
  REQUIRE(file.options->import);
  CHECK(file.options->import->kind == ImportKind::file);
  CHECK(file.options->import->source == "castle.schem");
  CHECK(file.options->import->at == VoxelPos{-10, 20, 30});
  const auto minecraft = parse({"import", "minecraft", "saves/valley", "--world", "w"});
  REQUIRE(minecraft.options);
  CHECK(minecraft.options->import->kind == ImportKind::minecraft);
  CHECK(parse({"import", "--luanti", "a", "--world", "w"}).options->import->source == "a");
  for (const char* bad : {"10,20", "10 20 30", "10,20,30,40", "1,2,x", "", "1,2,600000000"}) {
    CAPTURE(bad);
    CHECK_FALSE(parse({"import", "file", "a.schem", "--world", "w", "--at", bad}).options);
  }
  CHECK_FALSE(parse({"import", "--world", "w"}).options);
  CHECK_FALSE(parse({"import", "file", "--world", "w"}).options);
  CHECK_FALSE(parse({"import", "obj", "a.obj", "--world", "w"}).options);
}

TEST_CASE("a switch needs no value and may have one", "[server_options]") {
  const auto parsed = parse({"--insecure", "--i-know", "--world", "/world"});
  REQUIRE(parsed.options);
  CHECK(parsed.options->settings.at("insecure") == "true");
  CHECK(parsed.options->settings.at("i_know") == "true");
  CHECK(parsed.options->settings.at("world") == "/world");
  const auto with_value = parse({"--insecure", "false"});
  REQUIRE(with_value.options);
  CHECK(with_value.options->settings.at("insecure") == "false");
}

TEST_CASE("the arguments after control are the command, whatever they look like",
          "[server_options]") {
  const auto parsed =
      parse({"control", "--world", "valley", "log", "box", "-1", "2", "3", "-4", "5", "6"});
  REQUIRE(parsed.options);
  REQUIRE(parsed.options->control);
  CHECK(parsed.options->control->world == "valley");
  CHECK(parsed.options->control->words ==
        std::vector<std::string>{"log", "box", "-1", "2", "3", "-4", "5", "6"});
  for (const char* world : {"--world=valley", "--world"}) {
    std::vector<const char*> words = {"control", world};
    if (std::string(world) == "--world") words.push_back("valley");
    words.insert(words.end(), {"backup", "--to", "control"});
    const auto backup = parse(words);
    REQUIRE(backup.options);
    CHECK_FALSE(backup.options->backup);
    REQUIRE(backup.options->control);
    CHECK(backup.options->control->world == "valley");
    CHECK(backup.options->control->words == std::vector<std::string>{"backup", "--to", "control"});
  }
  const auto none = parse({"control", "--world", "valley"});
  CHECK_FALSE(none.options);
  CHECK(none.exit_code == 2);
}

TEST_CASE("a mistyped subcommand is the argument that the error names", "[server_options]") {
  std::ostringstream text;
  std::streambuf* const before = std::cerr.rdbuf(text.rdbuf());
  const auto parsed = parse({"contrl", "status"});
  std::cerr.rdbuf(before);
  CHECK(parsed.exit_code == 2);
  CHECK(
      text.str() ==
      "runstone-server: \"contrl\" is no subcommand (import, compact, copy, backup, pack, restore, repair, control) and no flag; "
      "--help lists the flags\n");
}

TEST_CASE("an unknown flag leads to the nearest one, also of a subcommand", "[server_options]") {
  const auto error_of = [](const std::vector<const char*>& arguments) {
    std::ostringstream text;
    std::streambuf* const before = std::cerr.rdbuf(text.rdbuf());
    const auto parsed = parse(arguments);
    std::cerr.rdbuf(before);
    CHECK(parsed.exit_code == 2);
    return text.str();
  };
  CHECK(error_of({"--sesions-max", "3"}).find("did you mean --sessions-max?") != std::string::npos);
  CHECK(error_of({"backup", "--world", "a", "--to", "b", "--progres"})
            .find("did you mean --progress?") != std::string::npos);
}

TEST_CASE("a mistyped address of a database is no folder", "[server_options]") {
  for (const char* bad : {"postgre://h/d", "mysql://h/d", "host=localhost dbname=x"}) {
    CAPTURE(bad);
    for (const std::vector<const char*>& line :
         std::vector<std::vector<const char*>>{{"copy", "--from", "a", "--to", bad},
                                               {"copy", "--from", bad, "--to", "a"},
                                               {"compact", "--world", bad, "--keep", "1"},
                                               {"backup", "--world", bad, "--to", "a"},
                                               {"backup", "--world", "a", "--to", bad},
                                               {"restore", "--from", bad, "--world", "a"},
                                               {"restore", "--from", "a", "--world", bad},
                                               {"import", "--luanti", "a", "--world", bad},
                                               {"control", "--world", bad, "status"}})
      CHECK(parse(line).exit_code == 2);
  }
  constexpr const char* kDatabase = "postgresql://h/d";
  CHECK(parse({"copy", "--from", "a", "--to", kDatabase}).options);
  CHECK(parse({"compact", "--world", kDatabase, "--keep", "1"}).options);
  CHECK(parse({"backup", "--world", kDatabase, "--to", "a"}).exit_code == 2);
  CHECK(parse({"restore", "--from", "a", "--world", kDatabase}).exit_code == 2);
}

TEST_CASE("a backup is a new folder, or one of a folder of backups", "[server_options]") {
  using Action = BackupFolderRequest::Action;
  const auto copy = parse({"backup", "--world", "w", "--to", "b"});
  REQUIRE(copy.options);
  REQUIRE(copy.options->backup);
  CHECK(copy.options->backup->world == "w");
  CHECK(copy.options->backup->to == "b");
  CHECK_FALSE(copy.options->backup_folder);
  const auto added = parse({"backup", "add", "--world", "w", "--folder", "b", "--keep-daily", "7"});
  REQUIRE(added.options);
  CHECK_FALSE(added.options->backup);
  REQUIRE(added.options->backup_folder);
  CHECK(added.options->backup_folder->action == Action::add);
  CHECK(added.options->backup_folder->world == "w");
  CHECK(added.options->backup_folder->folder == "b");
  CHECK(added.options->backup_folder->policy == BackupPolicy{0, 7, 0});
  const auto list = parse({"backup", "list", "--folder", "b", "--json"});
  REQUIRE(list.options->backup_folder);
  CHECK(list.options->backup_folder->action == Action::list);
  CHECK(list.options->backup_folder->json);
  const auto prune = parse({"backup", "prune", "--folder", "b", "--keep-hourly", "2", "--dry-run"});
  REQUIRE(prune.options->backup_folder);
  CHECK(prune.options->backup_folder->action == Action::prune);
  CHECK(prune.options->backup_folder->is_rehearsal);
  CHECK(prune.options->backup_folder->policy == BackupPolicy{2, 0, 0});
  const auto verify = parse({"backup", "verify", "--folder", "b", "--backup", "20261118T110640Z"});
  REQUIRE(verify.options->backup_folder);
  CHECK(verify.options->backup_folder->action == Action::verify);
  CHECK(verify.options->backup_folder->backup == "20261118T110640Z");
  const auto restored =
      parse({"restore", "--from", "b", "--backup", "20261118T110640Z", "--world", "w"});
  REQUIRE(restored.options->restore);
  CHECK(restored.options->restore->backup == "20261118T110640Z");
  const auto packed = parse({"pack", "w", "w.tar"});
  REQUIRE(packed.options->pack);
  CHECK(packed.options->pack->world == "w");
  CHECK(packed.options->pack->file == "w.tar");
  for (const std::vector<const char*>& line : std::vector<std::vector<const char*>>{
           {"pack", "w"},
           {"pack", "postgresql://h/d", "w.tar"},
           {"backup"},
           {"backup", "--world", "w"},
           {"backup", "--to", "b"},
           {"backup", "add", "--folder", "b"},
           {"backup", "add", "--world", "w"},
           {"backup", "list"},
           {"backup", "--world", "w", "list", "--folder", "b"},
           {"backup", "prune", "--folder", "b", "--keep-daily", "-1"},
           {"backup", "list", "--folder", "b", "prune", "--folder", "b"}}) {
    CAPTURE(line);
    CHECK(parse(line).exit_code == 2);
  }
}

TEST_CASE("losses are accepted on request", "[server_options]") {
  CHECK_FALSE(parse({"--world", "a"}).options->accept_losses);
  CHECK(parse({"--world", "a", "--accept-losses"}).options->accept_losses);
}

TEST_CASE("a new world is made on request", "[server_options]") {
  CHECK_FALSE(parse({"--world", "a"}).options->create);
  CHECK(parse({"--world", "a", "--create"}).options->create);
}

TEST_CASE("compact gives the space back unless the size is to be kept", "[server_options]") {
  const auto plain = parse({"compact", "--world", "a", "--keep", "9"});
  REQUIRE(plain.options->compact);
  CHECK(plain.options->compact->shrink);
  CHECK_FALSE(
      parse({"compact", "--world", "a", "--keep", "9", "--keep-size"}).options->compact->shrink);
  CHECK_FALSE(plain.options->compact->is_confirmed);
  CHECK(
      parse({"compact", "--world", "a", "--keep", "0", "--anyway"}).options->compact->is_confirmed);
}

TEST_CASE("an unknown flag ends the program with 2", "[server_options]") {
  const auto parsed = parse({"--worlds", "/world"});
  CHECK_FALSE(parsed.options);
  CHECK(parsed.exit_code == 2);
}

TEST_CASE("backup and restore name both folders", "[server_options]") {
  const auto backup = parse({"backup", "--world", "a", "--to", "b"});
  REQUIRE(backup.options->backup);
  CHECK(backup.options->backup->world == "a");
  CHECK(backup.options->backup->to == "b");
  const auto restore = parse({"restore", "--from", "b", "--world", "c"});
  REQUIRE(restore.options->restore);
  CHECK(restore.options->restore->from == "b");
  CHECK(restore.options->restore->world == "c");
  CHECK(parse({"backup", "--world", "a"}).exit_code == 2);
  CHECK(parse({"restore", "--world", "a"}).exit_code == 2);
}

TEST_CASE("standard input is a console or ends the server, not both", "[server_options]") {
  REQUIRE(parse({"--stop-with-input"}).options);
  CHECK(parse({"--stop-with-input"}).options->stop_with_input);
  CHECK_FALSE(parse({"--console"}).options->stop_with_input);
  CHECK(parse({"--stop-with-input", "--console"}).exit_code == 2);
}
