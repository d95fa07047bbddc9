// ClientProgram: the client under test, as a program. Lines go to its standard input, and its lines
// come from its standard output (docs/conformance.md has the contract). Thread: one.
#pragma once
#include <sys/types.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace runstone::conformance {

class ClientProgram {
 public:
  /// Starts the program. Its standard error goes to `errors`, a descriptor. Throws std::system_error
  /// if it cannot be started.
  ClientProgram(std::vector<std::string> words, int errors);
  /// Ends the program if it runs.
  ~ClientProgram();
  ClientProgram(const ClientProgram&) = delete;
  ClientProgram& operator=(const ClientProgram&) = delete;

  int descriptor() const { return out_; }
  void write_line(const std::string& line);
  /// Reads a bounded part of what has arrived, if no line is kept. Returns the next line, or nullopt
  /// if none is complete.
  std::optional<std::string> next();
  /// Returns true if the program has closed its standard output and all lines were taken.
  bool is_ended() const { return is_ended_ && lines_.empty(); }

 private:
  pid_t pid_ = -1;
  int in_ = -1, out_ = -1;
  std::string text_;  // of a line that is not complete
  std::deque<std::string> lines_;
  bool is_ended_ = false;
};

}  // namespace runstone::conformance
