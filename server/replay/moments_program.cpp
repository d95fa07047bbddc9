#include "server/replay/moments_program.hpp"

#include <algorithm>
#include <iomanip>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>

#include "common/core/hex.hpp"
#include "common/core/key_text.hpp"
#include "common/os/progress_line.hpp"
#include "server/history/world_diff.hpp"
#include "server/replay/digest_list.hpp"
#include "server/replay/world_copy.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

constexpr std::size_t kChunksListed = 20;  // in the table; the JSON has all

std::ostream& row(std::ostream& out, const char* name) {
  return out << std::left << std::setw(12) << name << std::right;
}

/// What both programs begin with.
struct Opened {
  std::unique_ptr<Store> store;
  std::unique_ptr<Generator> generator;
};

Result<Opened, std::string> open(const ReplayOptions& options) {
  auto store = open_world(options.world, StoreAccess::read_only);
  if (!store) return Unexpected<std::string>{store.error().message()};
  auto generator = generator_of(**store);
  if (!generator) return Unexpected<std::string>{generator.error()};
  return Opened{*std::move(store), *std::move(generator)};
}

Result<void, std::string> write_json(const ReplayOptions& options,
                                     const nlohmann::ordered_json& json) {
  if (options.json.empty()) return {};
  const auto written = write_text_file(options.json, json.dump(1) + "\n");
  if (!written) return Unexpected<std::string>{written.error().message()};
  return {};
}

/// Name of an author, as far as the world knows one.
std::string name_of(const std::map<AuthorId, std::string>& names, AuthorId author) {
  if (author == 0) return "the server";
  const auto found = names.find(author);
  return found == names.end() ? "" : found->second;
}

}  // namespace

Result<void, std::string> write_moment(const ReplayOptions& options, std::ostream& out) {
  auto opened = open(options);
  if (!opened) return Unexpected<std::string>{opened.error()};
  WorldReader& store = *opened->store;
  const auto last = store.last_sequence();
  if (!last) return Unexpected<std::string>{last.error().message()};
  const Sequence at = std::min(options.at, *last);
  const auto copy = [&] {
    ProgressLine line("chunks written", options.progress);
    return copy_world(store, *opened->generator, at, options.write_to,
                      [&](std::uint64_t done, std::uint64_t all) {
                        line.show(done, all);
                        return true;
                      });
  }();
  if (!copy) return Unexpected<std::string>{copy.error()};
  row(out, "world") << to_hex(store.meta().world_id) << "  " << store.file() << '\n';
  row(out, "moment") << "after sequence " << at << '\n';
  row(out, "written") << options.write_to << ", " << copy->chunks << " chunks\n";
  row(out, "digest") << to_hex(copy->world_digest) << '\n';
  return write_json(options, {{"world_id", to_hex(store.meta().world_id)},
                              {"seq", at},
                              {"written", options.write_to},
                              {"chunks", copy->chunks},
                              {"world_digest", to_hex(copy->world_digest)}});
}

Result<void, std::string> diff_moments(const ReplayOptions& options, std::ostream& out) {
  auto opened = open(options);
  if (!opened) return Unexpected<std::string>{opened.error()};
  WorldReader& store = *opened->store;
  const auto from = sequence_of(store, options.diff->first);
  if (!from) return Unexpected<std::string>{from.error().message()};
  const auto to = sequence_of(store, options.diff->second);
  if (!to) return Unexpected<std::string>{to.error().message()};
  const auto diff = [&] {
    ProgressLine line("edits read", options.progress);
    return diff_world(store, *opened->generator, *from, *to, [&](Sequence done, Sequence last) {
      line.show(done, last);
      return true;
    });
  }();
  if (!diff) return Unexpected<std::string>{diff.error().message()};
  const auto players = store.players();
  if (!players) return Unexpected<std::string>{players.error().message()};
  std::map<AuthorId, std::string> names;
  for (const PlayerRow& player : *players) names[player.author] = player.name;

  row(out, "world") << to_hex(store.meta().world_id) << "  " << store.file() << '\n';
  row(out, "moments") << "after sequence " << diff->from << " and after sequence " << diff->to
                      << ", " << diff->edits << " edits between\n";
  row(out, "voxels") << diff->voxels << " differ, in " << diff->chunks.size() << " chunks\n";
  nlohmann::ordered_json json = {{"world_id", to_hex(store.meta().world_id)},
                                 {"from", diff->from},
                                 {"to", diff->to},
                                 {"edits", diff->edits},
                                 {"voxels", diff->voxels},
                                 {"authors", nlohmann::ordered_json::array()},
                                 {"chunks", nlohmann::ordered_json::array()}};
  for (const WorldDiff::AuthorPart& part : diff->authors) {
    const std::string name = name_of(names, part.author);
    row(out, "author") << part.author << " " << name << ": " << part.voxels << " voxels, "
                       << part.edits << " edits\n";
    json["authors"].push_back(
        {{"author", part.author}, {"name", name}, {"edits", part.edits}, {"voxels", part.voxels}});
  }
  for (std::size_t i = 0; i < diff->chunks.size(); ++i) {
    const WorldDiff::ChunkPart& part = diff->chunks[i];
    if (i < kChunksListed) {
      row(out, "chunk") << text_of(part.key) << ": " << part.voxels << " voxels, " << part.edits
                        << " edits\n";
    }
    json["chunks"].push_back({{"x", part.key.at.x},
                              {"y", part.key.at.y},
                              {"z", part.key.at.z},
                              {"edits", part.edits},
                              {"voxels", part.voxels}});
  }
  if (diff->chunks.size() > kChunksListed) {
    row(out, "") << diff->chunks.size() - kChunksListed << " more chunks\n";
  }
  return write_json(options, json);
}

}  // namespace runstone
