// TextError: what is wrong in a text file, and where.
#pragma once
#include <cstdint>
#include <string>

namespace runstone {

struct TextError {
  std::string file;
  std::uint32_t line = 0;  // from 1; 0: the file as a whole
  std::string key;         // such as "material[3].colour"; empty if none
  std::string what;
  std::string message() const;  // "file:line: key: what"
};

}  // namespace runstone
