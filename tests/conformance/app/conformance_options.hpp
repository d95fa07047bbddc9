// The command line of runstone-conformance.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace runstone::conformance {

enum class Task { write_vectors, check_vectors };

struct ConformanceOptions {
  Task task = Task::check_vectors;
  std::string folder;  // of vectors
};

/// Reads the command line. Returns nullopt if the program has to end now, with `exit_code`; the text
/// is printed then.
std::optional<ConformanceOptions> conformance_options(int argc, char** argv, int& exit_code);

}  // namespace runstone::conformance
