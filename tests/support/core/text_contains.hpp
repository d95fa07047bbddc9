// Looks for a part of a text, such as a page or a log.
#pragma once
#include <string>

namespace runstone::test {

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace runstone::test
