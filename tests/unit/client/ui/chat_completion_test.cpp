#include "client/ui/chat_completion.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "server/admin/command_table.hpp"

using namespace runstone;

namespace {

ChatCompletion::Line at_end(const std::string& text) { return {text, text.size()}; }

ChatCompletion with_names() {
  ChatCompletion out;
  out.set_names({"ana", "Anatol", "the mole"});
  return out;
}

}  // namespace

TEST_CASE("tab completes names of players, one after another", "[client_ui]") {
  ChatCompletion completion = with_names();
  ChatCompletion::Line line = completion.complete(at_end("hello an"));
  CHECK(line == at_end("hello ana "));
  line = completion.complete(line);
  CHECK(line == at_end("hello Anatol "));
  CHECK(completion.complete(line) == at_end("hello ana "));
  CHECK(completion.complete(at_end("x")) == at_end("x"));
}

TEST_CASE("tab completes words of commands, and names in commands with quotes", "[client_ui]") {
  ChatCompletion completion = with_names();
  CHECK(completion.complete(at_end("/und")) == at_end("/undo "));
  CHECK(completion.complete(at_end("/rollback pre")) == at_end("/rollback preview "));
  CHECK(completion.complete(at_end("/kick the")) == at_end("/kick \"the mole\" "));
  CHECK(completion.complete(at_end("/kick \"the m")) == at_end("/kick \"the mole\" "));
  CHECK(completion.complete(at_end("the")) == at_end("the mole "));
  CHECK(completion.complete(at_end("/nothing like this")) == at_end("/nothing like this"));
}

TEST_CASE("what stands behind the cursor stays", "[client_ui]") {
  ChatCompletion completion = with_names();
  const ChatCompletion::Line line = completion.complete({"hi an how are you", 5});
  CHECK(line.text == "hi ana how are you");
  CHECK(line.cursor == 6);
  CHECK(completion.complete(line).text == "hi Anatol how are you");
}

TEST_CASE("an empty line completes to the first name, and without names nothing does",
          "[client_ui]") {
  CHECK(with_names().complete(at_end("")) == at_end("ana "));
  ChatCompletion nobody;
  CHECK(nobody.complete(at_end("")) == at_end(""));
}

TEST_CASE("the completed commands are commands of the server", "[client_ui]") {
  const std::string help = "\n" + command_help([](Right) { return true; }, true);
  const auto has = [&](const std::string& command) {
    // Commands with the same help share a line.
    return help.find("\n" + command) != std::string::npos ||
           help.find(", " + command) != std::string::npos;
  };
  for (const std::string_view command : completed_commands()) {
    INFO(command);
    CHECK(has(std::string(command)));
  }
  CHECK(std::ranges::is_sorted(completed_commands()));
  CHECK_FALSE(has("teleport"));
}

TEST_CASE("each command that players may give is completed", "[client_ui]") {
  for (const CommandRow& row : command_table()) {
    if (row.rule.is_local) continue;
    INFO(row.words);
    const std::string words = std::string(row.words) + " ";
    CHECK(std::ranges::any_of(completed_commands(), [&](std::string_view each) {
      const std::string command = std::string(each) + " ";
      return words.starts_with(command) || command.starts_with(words);
    }));
  }
}
