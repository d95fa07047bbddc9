#include "tests/support/page_example.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace runstone::test {

std::string page_example(std::string_view name) {
  std::ifstream file(RUNSTONE_SOURCE_DIR "/docs/protocol.md");
  std::string digits;
  bool is_inside = false;
  for (std::string line; std::getline(file, line);) {
    if (!is_inside) {
      is_inside = line == "```" + std::string(name);
      continue;
    }
    if (line == "```") return digits;
    line.resize(std::min(line.find("  "), line.size()));
    std::erase(line, ' ');
    digits += line;
  }
  throw std::runtime_error("docs/protocol.md has no example " + std::string(name));
}

}  // namespace runstone::test
