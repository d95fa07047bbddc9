#include "server/replay/replay_commands.hpp"

#include <nlohmann/json.hpp>
#include <ostream>

#include "server/replay/command_world.hpp"
#include "server/replay/rlog_file.hpp"
#include "server/replay/subcommand.hpp"

namespace runstone {

void declare_import(SubcommandOptions& command_line, ImportOptions& options) {
  command_line.common(options.common, "folder of the world; made if it holds none");
  command_line.text("FILE", options.file, "the .rlog file to append to the world's log");
  command_line.flag("--until-damage", options.until_damage,
                    "make a new world of a damaged file, with the edits before the damage");
}

Result<int, std::string> run_import(const ImportOptions& options, std::ostream& out) {
  const auto done = import_rlog({options.common.world, options.file, options.until_damage}, out);
  if (!done) return failure(done.error());
  row(out, "world") << place_name(options.common.world) << (done->made_world ? ", made\n" : "\n");
  row(out, "edits") << done->added << " added, " << done->known << " known, " << done->compacted
                    << " compacted\n";
  row(out, "log") << "ends with sequence " << done->last << '\n';
  const auto after = open_world(options.common.world, StoreAccess::read_only);
  if (!after) return failure(after.error().message());
  print_loss(out, **after);  // the file did not hold all that was lost
  const nlohmann::ordered_json json = {
      {"made_world", done->made_world}, {"added", done->added}, {"known", done->known},
      {"compacted", done->compacted},   {"last", done->last},   {"stopped", done->stopped}};
  const auto written = write_report(options.common.json, json.dump(1));
  if (!done->stopped.empty()) return failure(done->stopped);
  if (!written) return failure(written.error());
  return kReplayEqual;
}

}  // namespace runstone
