// No two headers define a class of the same name in namespace runstone: programs that link both,
// such as tests of server and client together, would mix their inline functions up.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>

TEST_CASE("each class of namespace runstone has a name of its own", "[house]") {
  const std::filesystem::path root = RUNSTONE_SOURCE_DIR;
  const std::regex definition(R"(^(?:class|struct|enum class) (\w+)[^;(:]*( : [^;(]*)?\{)");
  const std::regex space(R"(^namespace ([\w:]+) \{)");
  std::map<std::string, std::string> header_of;
  for (const char* folder : {"bindings", "client", "common", "protocol", "server"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() != ".hpp") continue;
      std::ifstream in(entry.path());
      std::string inside;
      for (std::string line; std::getline(in, line);) {
        std::smatch found;
        if (std::regex_search(line, found, space)) inside = found[1];
        if (!std::regex_search(line, found, definition) || inside != "runstone") continue;
        const auto [at, is_new] = header_of.try_emplace(found[1], entry.path().string());
        INFO(found[1] << " in " << at->second << " and " << entry.path());
        CHECK(is_new);
      }
    }
  }
  CHECK(header_of.size() > 300);
}
