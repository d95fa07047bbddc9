#include "server/replay/replay_commands.hpp"

#include <nlohmann/json.hpp>
#include <ostream>

#include "server/replay/command_world.hpp"
#include "server/replay/rlog_file.hpp"
#include "server/store/store.hpp"

namespace runstone {

void declare_export(SubcommandOptions& command_line, ExportOptions& options) {
  command_line.common(options.common, "folder of the world; a server may be running it");
  command_line.output_file("FILE", options.file, "the .rlog file to write; an old one is replaced");
  command_line.moment("--at", options.at, "last edit to export");
}

Result<int, std::string> run_export(const ExportOptions& options, std::ostream& out) {
  const auto store = open_world(options.common.world, StoreAccess::read_only);
  if (!store) return failure(store.error().message());
  const auto at = end_of_replay(**store, options.at);
  if (!at) return failure(at.error());
  const auto done = export_rlog(**store, options.file, *at);
  if (!done) return failure(done.error());
  print_world(out, **store);
  row(out, "edits") << done->edits << ", sequences " << done->first << " to " << done->last << '\n';
  row(out, "written") << options.file << ", " << done->bytes << " bytes\n";
  const nlohmann::ordered_json json = {
      {"edits", done->edits},
      {"first", done->first},
      {"last", done->last},
      {"lost", (*store)->loss() ? (*store)->loss()->message() : ""},
      {"bytes", done->bytes}};
  const auto written = write_report(options.common.json, json.dump(1));
  if (!written) return failure(written.error());
  return code_of_output(**store);
}

}  // namespace runstone
