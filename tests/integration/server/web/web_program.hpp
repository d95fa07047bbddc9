// WebProgram: runstone-web as a program of its own. A test reads its log and limits its open files.
#pragma once
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "common/os/child_program.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/net/port_file.hpp"

namespace runstone::test {

class WebProgram {
 public:
  /// Starts the gateway of the server whose socket is `web.sock` in the folder. Requires that it
  /// starts.
  explicit WebProgram(const TempFolder& folder) : log_file_(folder / "web.log") {
    ChildProgram program;
    program.words = {RUNSTONE_WEB_PROGRAM, "--listen",         "127.0.0.1:0",      "--port-file",
                     folder / "port",      "--gateway-socket", folder / "web.sock"};
    program.errors = ::open(log_file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    const int errors = program.errors;
    const auto child = start_program(std::move(program));
    ::close(errors);
    REQUIRE(child.has_value());
    child_ = *child;
    port_ = port_in(folder / "port");
    REQUIRE(port_ != 0);
    // The program writes this line when it has closed the file with the port.
    for (int i = 0; i < 1'000 && log().find("listening port=") == std::string::npos; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ~WebProgram() {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }
  WebProgram(const WebProgram&) = delete;
  WebProgram& operator=(const WebProgram&) = delete;

  std::uint16_t port() const { return port_; }
  std::string log() const {
    std::ifstream in(log_file_);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  /// Returns the numbers of the descriptors that the program has open.
  std::set<rlim_t> open_files() const {
    std::set<rlim_t> out;
    const std::string folder = "/proc/" + std::to_string(child_) + "/fd";
    for (const auto& file : std::filesystem::directory_iterator(folder))
      out.insert(std::stoul(file.path().filename().string()));
    return out;
  }
  /// Waits until the program has so many descriptors, for at most ten seconds.
  bool comes_to_have_files(std::size_t count) const {
    for (int i = 0; i < 1'000; ++i) {
      if (open_files().size() == count) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  /// From now on the program can only open a file after it has closed one. Requires that the
  /// numbers of its descriptors have no gap: a number behind a gap could not be used again.
  void forbid_more_files() {
    const std::set<rlim_t> open = open_files();
    REQUIRE(*open.rbegin() + 1 == open.size());
    REQUIRE(::prlimit(child_, RLIMIT_NOFILE, nullptr, &before_) == 0);
    const rlimit limit{open.size(), before_.rlim_max};
    REQUIRE(::prlimit(child_, RLIMIT_NOFILE, &limit, nullptr) == 0);
  }
  /// Takes forbid_more_files() back.
  void allow_files() { REQUIRE(::prlimit(child_, RLIMIT_NOFILE, &before_, nullptr) == 0); }
  /// From now on no file of the program may become larger than its log is now.
  void fill_log() {
    REQUIRE(::prlimit(child_, RLIMIT_FSIZE, nullptr, &before_) == 0);
    const rlimit limit{std::filesystem::file_size(log_file_), before_.rlim_max};
    REQUIRE(::prlimit(child_, RLIMIT_FSIZE, &limit, nullptr) == 0);
  }
  /// Takes fill_log() back.
  void make_room_in_log() { REQUIRE(::prlimit(child_, RLIMIT_FSIZE, &before_, nullptr) == 0); }
  /// Makes the program read its certificate again. Without one it logs that there is none.
  void hang_up() { REQUIRE(::kill(child_, SIGHUP) == 0); }

 private:
  const std::string log_file_;
  pid_t child_ = -1;
  std::uint16_t port_ = 0;
  rlimit before_{};
};

}  // namespace runstone::test
