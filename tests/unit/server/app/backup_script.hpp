// BackupScript: a script that stands for runstone-server where a server starts its backups.
#pragma once
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

class BackupScript {
 public:
  /// `lines`: of a shell script. Its variable FOLDER is the folder of the script.
  explicit BackupScript(const std::string& lines) {
    namespace fs = std::filesystem;
    const std::string file = folder / "program";
    std::ofstream(file) << "#!/bin/sh\nFOLDER='" << folder.path() << "'\n" << lines;
    fs::permissions(file, fs::perms::owner_all);
    if (const char* const before = std::getenv(kVariable)) before_ = before;
    ::setenv(kVariable, file.c_str(), 1);
  }
  ~BackupScript() {
    if (before_.empty()) {
      ::unsetenv(kVariable);
    } else {
      ::setenv(kVariable, before_.c_str(), 1);
    }
  }
  BackupScript(const BackupScript&) = delete;
  BackupScript& operator=(const BackupScript&) = delete;

  /// Waits until the script has written a line to this file of the folder, for a minute at most.
  /// Returns all that is in it.
  std::string written(const std::string& name) const {
    for (int i = 0; i < 600; ++i) {
      std::ifstream in(folder / name);
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      if (text.ends_with('\n')) return text;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return {};
  }

  TempFolder folder;

 private:
  static constexpr const char* kVariable = "RUNSTONE_SERVER";
  std::string before_;
};

}  // namespace runstone::test
