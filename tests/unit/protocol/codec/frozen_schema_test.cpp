// Nothing that a frozen schema declares may be removed. `flatc --conform` finds fields and kinds that
// moved or changed their type (protocol/schema/conform.cmake), but not those that are gone.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

namespace runstone::test {
namespace {

const std::filesystem::path kSchemas = RUNSTONE_SOURCE_DIR "/protocol/schema";

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the declarations of a schema as "table NAME: field", without comments and blanks.
std::set<std::string> declarations_of(const std::string& schema) {
  std::string text;
  std::istringstream lines(schema);
  for (std::string line; std::getline(lines, line);) text += line.substr(0, line.find("//")) + " ";
  std::set<std::string> out;
  for (std::size_t open = 0; (open = text.find('{', open)) != std::string::npos; ++open) {
    const std::size_t close = text.find('}', open);
    const std::size_t head = text.find_last_of(";}", open);
    std::istringstream words(text.substr(head + 1, open - head - 1));
    std::string what, name;
    words >> what >> name;
    std::string member;
    for (const char c : text.substr(open + 1, close - open - 1) + ";") {
      if (c != ';' && c != ',') {
        if (c != ' ') member += c;
        continue;
      }
      if (!member.empty()) out.insert(what + " " + name + ": " + member);
      member.clear();
    }
  }
  return out;
}

/// Returns the first declaration that is in the frozen schema only, or an empty text.
std::string removed(const std::string& frozen, const std::string& schema) {
  const std::set<std::string> now = declarations_of(schema);
  for (const std::string& declaration : declarations_of(frozen)) {
    if (!now.contains(declaration)) return declaration;
  }
  return "";
}

}  // namespace

TEST_CASE("no declaration of a frozen schema is removed", "[protocol]") {
  const std::string schema = read(kSchemas / "runstone.fbs");
  const std::set<std::string> now = declarations_of(schema);
  CHECK(now.contains("enum Kind: ReceiveAck=24"));
  CHECK(now.contains("struct Pose: yaw:ushort"));
  CHECK(now.contains("table Commit: edits:[ubyte]"));
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSchemas / "frozen")) {
    CAPTURE(entry.path());
    CHECK(removed(read(entry.path()), schema).empty());
    ++count;
  }
  CHECK(count > 0);
}

TEST_CASE("a removed field, kind or table is noticed", "[protocol]") {
  const std::string frozen = read(kSchemas / "frozen" / "runstone_v1.fbs");
  const auto without = [&frozen](const std::string& text) {
    const std::size_t at = frozen.find(text);
    REQUIRE(at != std::string::npos);
    return removed(frozen, std::string(frozen).erase(at, text.size()));
  };
  CHECK(without("text:string;               // in `refused`") == "table ViewState: text:string");
  CHECK(without(", CachedChunks = 26") == "enum Kind: CachedChunks=26");
  CHECK(without("table Durable { epoch:uint; seq:ulong; }") == "table Durable: epoch:uint");
}

}  // namespace runstone::test
