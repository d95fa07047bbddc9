#include "tests/conformance/app/conformance_program.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <ostream>

#include "tests/conformance/app/conformance_options.hpp"
#include "tests/conformance/scene/checklist.hpp"
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

/// Returns the scenes of these names, or nullopt if there is no scene of a name.
std::optional<std::vector<Scene>> chosen_scenes(const std::vector<std::string>& names,
                                                std::ostream& errors) {
  std::vector<Scene> all = all_scenes();
  if (names.empty()) return all;
  std::vector<Scene> out;
  for (const std::string& name : names) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Scene& scene) { return scene.name == name; });
    if (found == all.end()) {
      errors << "there is no scene \"" << name << "\"; see runstone-conformance list\n";
      return std::nullopt;
    }
    out.push_back(*found);
  }
  return out;
}

int judge(const ConformanceOptions& options, std::ostream& out, std::ostream& errors) {
  const auto scenes = chosen_scenes(options.scenes, errors);
  if (!scenes) return 2;
  StageOptions stage;
  stage.command = options.command;
  stage.is_encrypted = options.is_encrypted;
  stage.patience_ms = static_cast<int>(options.patience_s * 1000);
  const std::vector<Row> rows = play(*scenes, stage, options.jobs);
  print(rows, out);
  if (!options.json_file.empty()) {
    std::ofstream file(options.json_file, std::ios::binary);
    if (!(file << json_text(rows)) || !file.flush()) {
      errors << "cannot write " << options.json_file << '\n';
      return 2;
    }
  }
  return is_passed(rows) ? 0 : 1;
}

int list_scenes(std::ostream& out) {
  for (const Scene& scene : all_scenes())
    out << scene.name << ": " << scene.words << " [" << scene.section << "]\n";
  return 0;
}

}  // namespace

int conformance_program(int argc, char** argv, std::ostream& out, std::ostream& errors) {
  int exit_code = 0;
  const auto options = conformance_options(argc, argv, exit_code);
  if (!options) return exit_code;
  switch (options->task) {
    case Task::judge:
      return judge(*options, out, errors);
    case Task::list_scenes:
      return list_scenes(out);
    case Task::write_vectors:
      return write_vectors(options->folder, out, errors);
    case Task::check_vectors:
      return check_vectors(options->folder, out, errors);
  }
  return 2;
}

}  // namespace runstone::conformance
