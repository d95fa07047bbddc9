#include "tests/support/core/page_example.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace runstone::test {
namespace {

constexpr const char* kPage = RUNSTONE_SOURCE_DIR "/docs/protocol.md";
const std::string kFence = "```";

}  // namespace

std::string page_example(std::string_view name) {
  std::ifstream file(kPage);
  std::string digits;
  bool is_inside = false;
  for (std::string line; std::getline(file, line);) {
    if (!is_inside) {
      is_inside = line == kFence + std::string(name);
      continue;
    }
    if (line == kFence) return digits;
    line.resize(std::min(line.find("  "), line.size()));
    std::erase(line, ' ');
    digits += line;
  }
  throw std::runtime_error("docs/protocol.md has no example " + std::string(name));
}

std::vector<std::string> page_example_names() {
  std::ifstream file(kPage);
  std::vector<std::string> names;
  bool is_inside = false;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(kFence)) continue;
    if (!is_inside) names.push_back(line.substr(kFence.size()));
    is_inside = !is_inside;
  }
  return names;
}

}  // namespace runstone::test
