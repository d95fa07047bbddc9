// TempFolder: a folder for one test, removed with the object.
#pragma once
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "common/core/assert.hpp"

namespace runstone::test {

class TempFolder {
 public:
  TempFolder() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "runstone-test-XXXXXX").string();
    const char* made = ::mkdtemp(pattern.data());
    RUNSTONE_ASSERT(made != nullptr);
    path_ = pattern;
  }
  ~TempFolder() {
    std::error_code ignored;  // a failed test may have left anything behind
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace runstone::test
