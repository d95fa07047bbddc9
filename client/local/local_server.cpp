#include "client/local/local_server.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "client/local/local_worlds.hpp"
#include "common/core/hex.hpp"
#include "common/os/child_program.hpp"
#include "common/os/private_file.hpp"

namespace runstone {
namespace {

constexpr const char* kProgram = "runstone-server";
constexpr std::string_view kErrorPrefix = "runstone-server: ";
constexpr std::size_t kLogBytesMax = 1 << 20;

std::string port_file_of(const std::string& folder) { return folder + "/port"; }
std::string log_file_of(const std::string& folder) { return folder + "/server.log"; }

/// Returns the port in the file, or 0 if the server has not written it yet.
std::uint16_t read_port(const std::string& file) {
  const auto text = read_file(file, 16);
  std::uint16_t port = 0;
  if (text) std::from_chars(text->data(), text->data() + text->size(), port);
  return port;
}

/// Returns the last line of the log in which the server says why it ends, or an empty text.
std::string last_error_in(const std::string& log_file) {
  const auto text = read_file(log_file, kLogBytesMax);
  if (!text) return {};
  const std::size_t at = text->rfind(kErrorPrefix);
  if (at == std::string::npos) return {};
  const std::size_t first = at + kErrorPrefix.size();
  return text->substr(first, text->find('\n', first) - first);
}

/// Closes a descriptor at the end of a block.
struct Descriptor {
  explicit Descriptor(int number) : value(number) {}
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value;
};

ChildProgram command_line(const LocalServerConfig& config) {
  ChildProgram child;
  child.words = {config.program.empty() ? local_server_program() : config.program, "--world",
                 config.folder, "--listen", "127.0.0.1:0", "--port-file",
                 port_file_of(config.folder), "--operators", to_hex(config.player),
                 // The world is the player's own.
                 "--builder-budget", "unlimited", "--read-kib-per-second", "0",
                 "--stop-with-input"};
  if (!config.creation) return child;
  for (std::string word :
       {std::string("--create"), std::string("--generator"), config.creation->generator}) {
    child.words.push_back(std::move(word));
  }
  if (config.creation->seed) {
    child.words.emplace_back("--seed");
    child.words.push_back(std::to_string(*config.creation->seed));
  }
  return child;
}

}  // namespace

std::string local_server_program() {
  std::string beside = sibling_program("", "RUNSTONE_SERVER", kProgram);
  return ::access(beside.c_str(), X_OK) == 0 ? beside : kProgram;
}

Result<std::unique_ptr<LocalServer>, std::string> LocalServer::start(
    const LocalServerConfig& config) {
  if (!config.creation && !holds_world(config.folder))
    return failure(config.folder + ": holds no world");
  // The log is the first file of a new world's folder.
  const std::string log_file = log_file_of(config.folder);
  if (const auto made = write_private_file(log_file, ""); !made) return failure(made.error());
  const Descriptor log(::open(log_file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  std::array<int, 2> ends{-1, -1};
  if (log.value < 0 || ::pipe2(ends.data(), O_CLOEXEC) != 0)
    return failure(std::string("the server cannot be started: ") + std::strerror(errno));
  const Descriptor read_end(ends[0]);
  Descriptor write_end(ends[1]);
  std::error_code ignored;
  std::filesystem::remove(port_file_of(config.folder), ignored);
  ChildProgram child = command_line(config);
  const std::string program = child.words[0];
  child.in = read_end.value;
  child.out = child.errors = log.value;
  const auto pid = start_program(std::move(child));
  if (!pid) {
    const bool is_missing = pid.error() == ENOENT && program == kProgram;
    return failure(is_missing
                       ? "runstone-server is neither beside this program nor on PATH: install it, "
                         "or set RUNSTONE_SERVER to its path"
                       : program + ": cannot be started: " + std::strerror(pid.error()));
  }
  return std::unique_ptr<LocalServer>(
      new LocalServer(*pid, std::exchange(write_end.value, -1), config.folder));
}

LocalServer::~LocalServer() { stop(); }

LocalServer::State LocalServer::poll() {
  if (state_ == State::ended) return state_;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) == pid_) {
    on_ended(status);
  } else if (state_ == State::starting) {
    port_ = read_port(port_file_of(folder_));
    if (port_ != 0) state_ = State::running;
  }
  return state_;
}

void LocalServer::on_ended(int status) {
  pid_ = -1;
  state_ = State::ended;
  const bool was_asked = input_ < 0;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && was_asked) return;
  failure_ = last_error_in(log_file_of(folder_));
  if (failure_.empty()) {
    failure_ = "the server of this world " + how_it_ended(status) + "; its last lines are in " +
               log_file_of(folder_);
  }
}

void LocalServer::request_stop() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
}

void LocalServer::stop() {
  request_stop();
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(kStopMs);
  while (poll() != State::ended) {
    if (std::chrono::steady_clock::now() >= end) ::kill(pid_, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

}  // namespace runstone
