#include "server/store/store_error.hpp"

namespace runstone {

std::string StoreError::message() const {
  std::string line = file;
  for (const std::string* part : {&where, &what}) {
    if (part->empty()) continue;
    if (!line.empty()) line += ": ";
    line += *part;
  }
  return line;
}

}  // namespace runstone
