// ImportError: why a world of another program cannot be imported.
#pragma once
#include <string>

namespace runstone {

struct ImportError {
  std::string file;  // or the folder
  std::string what;
  std::string message() const { return file + ": " + what; }
};

}  // namespace runstone
