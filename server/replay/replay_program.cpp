#include "server/replay/replay_program.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/command_line/help_options.hpp"
#include "common/core/assert.hpp"
#include "common/core/version.hpp"
#include "server/replay/replay_commands.hpp"
#include "server/replay/subcommand.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

std::vector<Subcommand> subcommands() {
  return {
      make_subcommand("verify", "rebuild the world from base and log, and compare digests",
                      declare_verify, run_verify),
      make_subcommand("diff", "list what differs between two moments, and whose edits changed it",
                      declare_diff, run_diff),
      make_subcommand("copy", "write the world of a moment as a new world", declare_copy, run_copy),
      make_subcommand("export", "write the log to an .rlog file", declare_export, run_export),
      make_subcommand("dump", "write the materials of a box of the world to an .npy file",
                      declare_dump, run_dump),
      make_subcommand("import", "append an .rlog file to the log of a world", declare_import,
                      run_import),
      make_subcommand("play", "play the log into a live server", declare_play, run_play),
      make_subcommand("timelapse", "draw the world as it grew", declare_timelapse, run_timelapse),
      make_subcommand("keyframes", "make the keyframes that the world lacks", declare_keyframes,
                      run_keyframes),
      make_subcommand("bench", "time reading the log and rebuilding the world", declare_bench,
                      run_bench),
  };
}

/// Flags that a person may type in place of a subcommand, and the command line to use instead.
struct OldFlag {
  std::string_view flag, spelling;
};
constexpr std::array<OldFlag, 9> kOldFlags = {{{"--verify", "verify --world DIR"},
                                               {"--diff", "diff --world DIR --from A --to B"},
                                               {"--write", "copy --world DIR [--at MOMENT] FOLDER"},
                                               {"--export", "export --world DIR FILE"},
                                               {"--import", "import --world DIR FILE"},
                                               {"--into", "play --world DIR --connect HOST:PORT"},
                                               {"--timelapse", "timelapse --world DIR FOLDER"},
                                               {"--keyframes", "keyframes --world DIR"},
                                               {"--bench", "bench --world DIR"}}};

/// Returns the new spelling for a command line that begins with an option instead of a subcommand.
std::string new_spelling(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument =
        std::string_view(argv[i]).substr(0, std::string_view(argv[i]).find('='));
    for (const auto& [flag, spelling] : kOldFlags) {
      if (argument == flag) {
        return std::string(flag) + " is a subcommand now: runstone-replay " + std::string(spelling);
      }
    }
  }
  return "a subcommand comes first, such as: runstone-replay verify --world DIR [--quick]";
}

/// Returns true if the command line begins with an option that is no option of the program itself.
bool lacks_subcommand(int argc, const char* const* argv) {
  if (argc < 2) return true;
  const std::string_view first = argv[1];
  return first.starts_with('-') && first != "--help" && first != "-h" && first != "--version" &&
         !is_help_option(first);
}

/// Returns "" if the program has the subcommand, otherwise a line that lists the subcommands.
std::string unknown_subcommand(const std::vector<Subcommand>& all, std::string_view name) {
  std::string names;
  for (const Subcommand& subcommand : all) {
    if (subcommand.name == name) return {};
    names += (names.empty() ? "" : ", ") + std::string(subcommand.name);
  }
  return "\"" + std::string(name) + "\" is no subcommand: " + names;
}

int cannot_read(std::ostream& err, const std::string& message) {
  err << "runstone-replay: " << message << '\n';
  return kReplayCannotRead;
}

}  // namespace

int replay_program(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  if (lacks_subcommand(argc, argv)) return cannot_read(err, new_spelling(argc, argv));
  const std::vector<Subcommand> all = subcommands();
  const bool wants_help = std::string_view(argv[1]).starts_with('-');
  if (const std::string wrong = unknown_subcommand(all, argv[1]); !wants_help && !wrong.empty()) {
    return cannot_read(err, wrong);
  }
  CLI::App program(
      "Rebuilds a world from base and edit log. Exit code 0: done, and equal; 1: different; "
      "2: cannot read.",
      "runstone-replay");
  program.require_subcommand(1);
  program.set_version_flag(
      "--version", "runstone-replay " + std::string(version()) + ", " + world_formats_text());
  add_help_options(program, "runstone-replay");
  program.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  struct Entry {
    CLI::App* app;
    std::function<Result<int, std::string>(std::ostream&)> run;
  };
  std::vector<Entry> entries;
  for (const Subcommand& subcommand : all) {
    CLI::App* const app = program.add_subcommand(subcommand.name, subcommand.help);
    SubcommandOptions options(*app);
    entries.push_back({app, subcommand.add(options)});
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    // CLI11 lists the arguments in reverse order.
    return cannot_read(err, "unexpected argument \"" + program.remaining(true).front() + "\"");
  } catch (const CLI::ParseError& error) {
    return program.exit(error, out, err) == 0 ? 0 : kReplayCannotRead;
  }
  const auto chosen = std::find_if(entries.begin(), entries.end(),
                                   [](const Entry& entry) { return entry.app->parsed(); });
  RUNSTONE_ASSERT(chosen != entries.end());  // require_subcommand() above
  const auto code = chosen->run(out);
  return code ? *code : cannot_read(err, code.error());
}

}  // namespace runstone
