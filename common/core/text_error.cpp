#include "common/core/text_error.hpp"

namespace runstone {

std::string TextError::message() const {
  std::string out = file;
  if (line != 0) out.append(":").append(std::to_string(line));
  if (!key.empty()) out.append(": ").append(key);
  return out.append(": ").append(what);
}

}  // namespace runstone
