#include "tests/conformance/app/conformance_options.hpp"

#include <CLI/CLI.hpp>

#include "protocol/program_version.hpp"

namespace runstone::conformance {

std::optional<ConformanceOptions> conformance_options(int argc, char** argv, int& exit_code) {
  ConformanceOptions out;
  CLI::App app{"Golden vectors of the formats of Runstone, and a judge of clients"};
  app.require_subcommand(1);
  app.set_version_flag("--version", program_version("runstone-conformance"));
  CLI::App* vectors = app.add_subcommand("vectors", "write golden vectors as JSON files");
  bool is_check = false;
  vectors->add_option("DIR", out.folder, "the folder of the files")->required();
  vectors->add_flag("--check", is_check, "compare the files that are there, and write nothing");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    exit_code = app.exit(error) == 0 ? 0 : 2;
    return std::nullopt;
  }
  out.task = is_check ? Task::check_vectors : Task::write_vectors;
  return out;
}

}  // namespace runstone::conformance
