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
  CLI::App* list = app.add_subcommand("list", "list the scenes");
  CLI::App* judge = app.add_subcommand("judge", "play scenes to a client and print its score");
  bool is_plain = false;
  judge->add_option("--scene", out.scenes, "play this scene; may be given several times");
  judge->add_flag("--insecure", is_plain, "without TLS, for clients whose TLS has no exporter");
  judge->add_option("--jobs", out.jobs, "scenes that are played at a time; default 4")
      ->check(CLI::Range(1, 64));
  judge->add_option("--patience", out.patience_s, "seconds that each step may take; default 10")
      ->check(CLI::Range(0.1, 600.0));
  judge->add_option("--json", out.json_file, "write the rows to this file");
  judge->add_option("COMMAND", out.command, "the client and its arguments")->required();
  judge->positionals_at_end();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    exit_code = app.exit(error) == 0 ? 0 : 2;
    return std::nullopt;
  }
  out.is_encrypted = !is_plain;
  if (list->parsed()) out.task = Task::list_scenes;
  if (judge->parsed()) out.task = Task::judge;
  if (vectors->parsed()) out.task = is_check ? Task::check_vectors : Task::write_vectors;
  return out;
}

}  // namespace runstone::conformance
