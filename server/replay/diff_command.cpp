#include "server/replay/replay_commands.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <ostream>

#include "common/core/hex.hpp"
#include "common/core/key_text.hpp"
#include "common/os/progress_line.hpp"
#include "server/history/world_diff.hpp"
#include "server/replay/command_world.hpp"
#include "server/replay/subcommand.hpp"

namespace runstone {
namespace {

using Names = std::map<AuthorId, std::string>;

constexpr std::size_t kChunksListed = 20;  // in the table; the JSON report lists all

/// Returns the name of an author, or "" if the world has none.
std::string name_of(const Names& names, AuthorId author) {
  if (author == 0) return "the server";
  const auto found = names.find(author);
  return found == names.end() ? "" : found->second;
}

void print_table(std::ostream& out, const Store& store, const WorldDiff& diff, const Names& names) {
  print_world(out, store);
  row(out, "moments") << "after sequence " << diff.from << " and after sequence " << diff.to << ", "
                      << diff.edits << " edits between\n";
  row(out, "voxels") << diff.voxels << " differ, in " << diff.chunks.size() << " chunks\n";
  for (const WorldDiff::AuthorPart& part : diff.authors) {
    row(out, "author") << part.author << " " << name_of(names, part.author) << ": " << part.voxels
                       << " voxels, " << part.edits << " edits\n";
  }
  for (std::size_t i = 0; i < diff.chunks.size() && i < kChunksListed; ++i) {
    const WorldDiff::ChunkPart& part = diff.chunks[i];
    row(out, "chunk") << text_of(part.key) << ": " << part.voxels << " voxels, " << part.edits
                      << " edits\n";
  }
  if (diff.chunks.size() > kChunksListed) {
    row(out, "") << diff.chunks.size() - kChunksListed << " more chunks\n";
  }
}

nlohmann::ordered_json report_json(const Store& store, const WorldDiff& diff, const Names& names) {
  nlohmann::ordered_json json = {{"world_id", to_hex(store.meta().world_id)},
                                 {"from", diff.from},
                                 {"to", diff.to},
                                 {"edits", diff.edits},
                                 {"voxels", diff.voxels},
                                 {"authors", nlohmann::ordered_json::array()},
                                 {"chunks", nlohmann::ordered_json::array()}};
  for (const WorldDiff::AuthorPart& part : diff.authors) {
    json["authors"].push_back({{"author", part.author},
                               {"name", name_of(names, part.author)},
                               {"edits", part.edits},
                               {"voxels", part.voxels}});
  }
  for (const WorldDiff::ChunkPart& part : diff.chunks) {
    json["chunks"].push_back({{"x", part.key.at.x},
                              {"y", part.key.at.y},
                              {"z", part.key.at.z},
                              {"edits", part.edits},
                              {"voxels", part.voxels}});
  }
  return json;
}

}  // namespace

void declare_diff(SubcommandOptions& command_line, DiffOptions& options) {
  using Presence = SubcommandOptions::Presence;
  command_line.common(options.common, "folder of the world; a server may be running it");
  command_line.moment("--from", options.from, "the earlier moment", Presence::required);
  command_line.moment("--to", options.to, "the later moment", Presence::required);
}

Result<int, std::string> run_diff(const DiffOptions& options, std::ostream& out) {
  const auto world = open_for_reading(options.common.world);
  if (!world) return failure(world.error());
  Store& store = *world->store;
  const auto from = end_of_replay(store, options.from);
  if (!from) return failure(from.error());
  const auto to = end_of_replay(store, options.to);
  if (!to) return failure(to.error());
  const auto diff = [&] {
    ProgressLine line("edits read", options.common.progress);
    return diff_world(store, *world->generator, *from, *to, [&](Sequence done, Sequence last) {
      line.show(done, last);
      return true;
    });
  }();
  if (!diff) return failure(diff.error().message());
  const auto players = store.players();
  if (!players) return failure(players.error().message());
  Names names;
  for (const PlayerRow& player : *players) names[player.author] = player.name;
  print_table(out, store, *diff, names);
  const auto written = write_report(options.common.json, report_json(store, *diff, names).dump(1));
  if (!written) return failure(written.error());
  return kReplayEqual;
}

}  // namespace runstone
