// docs/protocol.md names settings and their defaults. The defaults of the server are compared with it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <string>

#include "server/admin/server_config.hpp"

namespace runstone::protocol_page_test {
namespace {

/// Returns the settings that have numbers, and their defaults as a page writes them: "10,000".
std::map<std::string, std::string> default_numbers() {
  std::map<std::string, std::string> out;
  const std::string toml = to_toml(ServerConfig{});
  for (std::size_t at = 0; at < toml.size(); at = toml.find('\n', at) + 1) {
    const std::string line = toml.substr(at, toml.find('\n', at) - at);
    const std::size_t equals = line.find(" = ");
    if (equals == std::string::npos) continue;
    std::string digits = line.substr(equals + 3);
    digits.resize(std::min(digits.find_first_not_of("0123456789"), digits.size()));
    for (std::size_t end = digits.size(); end > 3; end -= 3) digits.insert(end - 3, ",");
    if (!digits.empty()) out[line.substr(0, equals)] = digits;
  }
  return out;
}

/// Returns true if the text has the number, and not only as a part of a longer one.
bool has_number(const std::string& text, const std::string& number) {
  const std::string digits = "0123456789";
  for (std::size_t at = text.find(number); at != std::string::npos;
       at = text.find(number, at + 1)) {
    const std::size_t end = at + number.size();
    const bool begins = at == 0 || (digits + ",").find(text[at - 1]) == std::string::npos;
    const bool ends = end == text.size() || digits.find(text[end]) == std::string::npos;
    const bool goes_on = end + 1 < text.size() && text[end] == ',' &&
                         digits.find(text[end + 1]) != std::string::npos;
    if (begins && ends && !goes_on) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("the page of the protocol has the defaults of what a client may send", "[admin][docs]") {
  std::map<std::string, std::string> defaults = default_numbers();
  defaults["range_seats_percent"] = "half";
  std::ifstream file(RUNSTONE_SOURCE_DIR "/docs/protocol.md");
  std::string line;
  while (std::getline(file, line) && line != "### What a client may send") {
  }
  std::size_t named = 0;
  while (std::getline(file, line) && !line.starts_with("## ")) {
    if (!line.starts_with("| ")) continue;
    for (std::size_t at = line.find("(`"); at != std::string::npos; at = line.find("(`", at + 1)) {
      const std::string name = line.substr(at + 2, line.find('`', at + 2) - at - 2);
      CAPTURE(line, name);
      REQUIRE(defaults.contains(name));
      CHECK((defaults[name] == "half" ? line.find("half") != std::string::npos
                                      : has_number(line, defaults[name])));
      ++named;
    }
  }
  CHECK(named >= 14);
}

}  // namespace runstone::protocol_page_test
