// Reads a report that a program wrote. A file that is missing or is no JSON throws.
#pragma once
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace runstone::test {

inline nlohmann::json read_json(const std::string& file) {
  std::ifstream in(file);
  return nlohmann::json::parse(in);
}

}  // namespace runstone::test
