#include "client/app/key_program.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <sstream>

#include "client/net/key_file.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {
namespace {

constexpr SealCost kCheap{1, 8};
using Verb = KeyCommand::Verb;

/// Runs one command. Returns its output, or "ERROR: " and the error.
std::string run(const KeyCommand& command, const std::string& input = "") {
  std::istringstream in(input);
  std::ostringstream out;
  const auto done = run_key_program(command, in, out, kCheap);
  return done ? out.str() : "ERROR: " + done.error();
}

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("a key is shown, exported and imported", "[client][key]") {
  const TempFolder folder;
  const std::string key = folder / "ana.key", words = folder / "words", copy = folder / "copy.key",
                    file = folder / "exported";
  load_or_create_key(key);
  write(words, "one two three\n");
  const std::string shown = run({Verb::show, key, "", ""});
  CHECK(shown.starts_with("public key  "));
  CHECK(shown.find("\nfingerprint ") != std::string::npos);
  SECTION("through a file") {
    CHECK(run({Verb::export_key, key, file, words}) == shown);
    struct stat info{};
    REQUIRE(::stat(file.c_str(), &info) == 0);
    CHECK((info.st_mode & 0777) == 0600);
    CHECK(run({Verb::export_key, key, file, words}).starts_with("ERROR: " + file));
    CHECK(run({Verb::import_key, copy, file, words}) == shown);
  }
  SECTION("through the terminal") {
    const std::string line = run({Verb::export_key, key, "", words});
    CHECK(line.starts_with("runstone-key-1:"));
    CHECK(run({Verb::import_key, copy, "", words}, line) == shown);
  }
  SECTION("through files of another editor") {
    const std::string line = run({Verb::export_key, key, "", words});
    write(words, "\xEF\xBB\xBFone two three\r\n");
    write(file, "\xEF\xBB\xBF" + line.substr(0, line.find('\n')) + "\r\n");
    CHECK(run({Verb::import_key, copy, file, words}) == shown);
  }
  CHECK(text_of(copy) == text_of(key));
  CHECK(run({Verb::show, copy, "", ""}) == shown);
}

TEST_CASE("an import overwrites nothing and says what is wrong", "[client][key]") {
  const TempFolder folder;
  const std::string key = folder / "ana.key", words = folder / "words", other = folder / "other";
  load_or_create_key(key);
  write(words, "one two three\n");
  write(other, "one two four\n");
  const std::string line = run({Verb::export_key, key, "", words});
  const std::string before = text_of(key);
  CHECK(run({Verb::import_key, key, "", words}, line) == "ERROR: " + key + ": File exists");
  CHECK(text_of(key) == before);
  const std::string copy = folder / "copy.key";
  CHECK(run({Verb::import_key, copy, "", other}, line) ==
        "ERROR: the passphrase is wrong, or the exported key is damaged");
  CHECK(run({Verb::import_key, copy, "", words}, "hello\n") ==
        "ERROR: this is no exported key of version 1: it begins with \"runstone-key-1:\"");
  CHECK(run({Verb::import_key, copy, "", words}) ==
        "ERROR: standard input: cannot be read, or its first line is empty");
  CHECK(run({Verb::import_key, copy, folder / "none", words})
            .starts_with("ERROR: " + (folder / "none")));
  CHECK(run({Verb::import_key, copy, "", folder / "none"}, line)
            .starts_with("ERROR: " + (folder / "none")));
  CHECK(run({Verb::show, copy, "", ""}).starts_with("ERROR: " + copy));
  write(words, "short\n");
  CHECK(run({Verb::export_key, key, "", words}) ==
        "ERROR: the passphrase has fewer than 8 bytes: take some words");
}

TEST_CASE("the command line of key names a verb and a key", "[client][key]") {
  const char* shown[] = {"key", "show", "--key", "a.key"};
  const auto parsed = parse_key_command(4, shown);
  REQUIRE(parsed.command);
  CHECK(parsed.command->verb == Verb::show);
  CHECK(parsed.command->key_file == "a.key");
  const char* imported[] = {"key", "import", "--key", "a.key", "--in", "f", "--passphrase-file",
                            "p"};
  const auto more = parse_key_command(8, imported);
  REQUIRE(more.command);
  CHECK(more.command->verb == Verb::import_key);
  CHECK(more.command->file == "f");
  CHECK(more.command->passphrase_file == "p");
  const char* sent[] = {"key", "send", "--key", "a.key", "--connect", "example.org:5000"};
  const auto send = parse_key_command(6, sent);
  REQUIRE(send.command);
  CHECK(send.command->verb == Verb::send);
  CHECK(send.command->server == HostPort{"example.org", 5000});
  CHECK(send.command->tls.has_value());
  CHECK(parse_key_command(4, sent).exit_code == 2);
  const char* received[] = {"key",       "receive", "--key",      "a.key",
                            "--connect", "[::1]",   "--insecure", "0000-0000"};
  const auto receive = parse_key_command(8, received);
  REQUIRE(receive.command);
  CHECK(receive.command->verb == Verb::receive);
  CHECK(receive.command->code == "0000-0000");
  CHECK_FALSE(receive.command->tls.has_value());
  CHECK(parse_key_command(6, received).command->code.empty());
  CHECK(parse_key_command(1, shown).exit_code == 2);
  CHECK(parse_key_command(2, shown).exit_code == 2);
}

}  // namespace runstone::test
