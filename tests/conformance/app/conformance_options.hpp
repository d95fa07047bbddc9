// The command line of runstone-conformance.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace runstone::conformance {

enum class Task { write_vectors, check_vectors, list_scenes, judge };

struct ConformanceOptions {
  Task task = Task::check_vectors;
  std::string folder;                // of vectors
  std::vector<std::string> scenes;   // to play; empty: all
  std::vector<std::string> command;  // of the client
  bool is_encrypted = true;
  unsigned jobs = 4;
  double patience_s = 10;  // of each step of a scene
  std::string json_file;   // for the rows; empty: none
};

/// Reads the command line. Returns nullopt if the program has to end now, with `exit_code`; the text
/// is printed then.
std::optional<ConformanceOptions> conformance_options(int argc, char** argv, int& exit_code);

}  // namespace runstone::conformance
