#include "tests/conformance/app/conformance_program.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>

#include "tests/conformance/app/conformance_options.hpp"
#include "tests/conformance/vectors/vector_file.hpp"

namespace runstone::conformance {
namespace {

int write_vectors(const std::string& folder, std::ostream& out, std::ostream& errors) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  for (const VectorFile& file : vector_files()) {
    const std::string path = folder + "/" + file.name;
    std::ofstream stream(path, std::ios::binary);
    if (!(stream << text_of(file.content)) || !stream.flush()) {
      errors << "cannot write " << path << '\n';
      return 2;
    }
    out << path << '\n';
  }
  return 0;
}

int check_vectors(const std::string& folder, std::ostream& out, std::ostream& errors) {
  int code = 0;
  for (const VectorFile& file : vector_files()) {
    const std::string path = folder + "/" + file.name;
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (text.empty()) {
      errors << "cannot read " << path << '\n';
      return 2;
    }
    const auto why = difference(file, text);
    out << path << ": " << (why ? *why : "ok") << '\n';
    if (why) code = 1;
  }
  return code;
}

}  // namespace

int conformance_program(int argc, char** argv, std::ostream& out, std::ostream& errors) {
  int exit_code = 0;
  const auto options = conformance_options(argc, argv, exit_code);
  if (!options) return exit_code;
  switch (options->task) {
    case Task::write_vectors:
      return write_vectors(options->folder, out, errors);
    case Task::check_vectors:
      return check_vectors(options->folder, out, errors);
  }
  return 2;
}

}  // namespace runstone::conformance
