#include "server/replay/replay_commands.hpp"

#include <nlohmann/json.hpp>
#include <ostream>

#include "common/core/hex.hpp"
#include "common/os/progress_line.hpp"
#include "server/replay/command_world.hpp"
#include "server/replay/subcommand.hpp"
#include "server/replay/world_copy.hpp"

namespace runstone {
void declare_copy(SubcommandOptions& command_line, CopyOptions& options) {
  command_line.common(options.common, "folder of the world; a server may be running it");
  command_line.folder("FOLDER", options.folder, "folder of the new world; empty, or not there");
  command_line.moment("--at", options.at, "the moment to copy");
}

Result<int, std::string> run_copy(const CopyOptions& options, std::ostream& out) {
  const auto world = open_for_reading(options.common.world, options.at);
  if (!world) return failure(world.error());
  Store& store = *world->store;
  const auto end = end_in_log(*world);
  if (!end) return failure(end.error());
  const Sequence at = *end;
  const auto copy = [&] {
    ProgressLine line("chunks written", options.common.progress);
    return copy_world(store, *world->generator, at, options.folder, out,
                      [&](std::uint64_t done, std::uint64_t all) {
                        line.show(done, all);
                        return true;
                      });
  }();
  if (!copy) return failure(copy.error());
  print_world(out, store);
  row(out, "moment") << "after sequence " << at << '\n';
  row(out, "written") << options.folder << ", " << copy->chunks << " chunks\n";
  row(out, "digest") << to_hex(copy->world_digest) << '\n';
  row(out, "left out")
      << "the log, players, names, rights and the server's key: it is a new world. "
         "To keep them, use `runstone-server backup` or `runstone-server copy`\n";
  const nlohmann::ordered_json json = {{"world_id", to_hex(store.meta().world_id)},
                                       {"seq", at},
                                       {"written", options.folder},
                                       {"chunks", copy->chunks},
                                       {"lost", store.loss() ? store.loss()->message() : ""},
                                       {"world_digest", to_hex(copy->world_digest)}};
  const auto written = write_report(options.common.json, json.dump(1));
  if (!written) return failure(written.error());
  return code_of_output(store);
}

}  // namespace runstone
