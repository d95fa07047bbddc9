#include "server/replay/rlog_file.hpp"

#include <fcntl.h>
#include <sodium.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <map>
#include <optional>
#include <ostream>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "common/os/new_folder.hpp"
#include "common/os/output_file.hpp"
#include "common/os/private_file.hpp"
#include "common/rlog/rlog_reader.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

constexpr std::size_t kEditsPerTransaction = 4096;
constexpr mode_t kFileMode = 0600;  // the file has names and keys of players

std::string system_error_text() { return std::generic_category().message(errno); }

/// A file that is open for reading. The destructor closes it.
class File {
 public:
  explicit File(const std::string& name)
      : descriptor_(::open(name.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  bool is_open() const { return descriptor_ >= 0; }

  /// Reads as an RlogSource does.
  std::optional<std::size_t> read(std::uint64_t position, std::span<std::uint8_t> out) const {
    std::size_t got = 0;
    while (got < out.size()) {
      const ssize_t done = ::pread(descriptor_, out.data() + got, out.size() - got,
                                   static_cast<off_t>(position + got));
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) return std::nullopt;
      if (done == 0) break;
      got += static_cast<std::size_t>(done);
    }
    return got;
  }

 private:
  int descriptor_;
};

Result<RlogWorld, std::string> world_of(WorldReader& store, const LogEnd& head) {
  const auto has_base = store.has_base();
  if (!has_base) return failure(has_base.error().message());
  // meta() was read when the world was opened. Since then retention may have moved materials into
  // it.
  const auto materials = store.materials(head.version.seq);
  if (!materials) return failure(materials.error().message());
  const WorldMeta& meta = store.meta();
  RlogWorld world;
  world.world_id = meta.world_id;
  world.chunk_edge = meta.chunk_edge;
  world.generator = meta.generator;
  world.materials = to_toml(*materials);
  world.spawn = {meta.spawn.x, meta.spawn.y, meta.spawn.z};
  world.has_base = *has_base;
  world.head = head.version;
  world.head_us = head.time_us;
  return world;
}

Result<std::vector<RlogPlayer>, std::string> players_of(WorldReader& store) {
  const auto rows = store.players();
  if (!rows) return failure(rows.error().message());
  std::vector<RlogPlayer> players;
  for (const PlayerRow& row : *rows) {
    if (row.name.size() > kRlogNameBytesMax) {
      return failure(store.file() + ": player author=" + std::to_string(row.author) +
                     ": name is too long");
    }
    players.push_back({row.author, row.key, row.name});
  }
  return players;
}

Result<RlogExport, std::string> write_rlog(WorldReader& store, FileWriter& out,
                                           const std::string& file, Sequence at,
                                           RlogOptions options) {
  const auto bad = [&](const RlogError& error) { return failure(file + ": " + error.message()); };
  const auto head = store.log_head();
  if (!head) return failure(head.error().message());
  const auto world = world_of(store, *head);
  if (!world) return failure(world.error());
  const auto range = store.log_range();
  if (!range) return failure(range.error().message());
  // The players are read after the range, because a running server adds players before their edits.
  const auto players = players_of(store);
  if (!players) return failure(players.error());
  RlogExport done;
  done.first = head->version.seq + 1;
  done.last = std::max(std::min(at, range->last.version.seq), head->version.seq);
  RlogWriter writer([&](ByteView bytes) { return out.write(bytes); }, options);
  if (const auto begun = writer.begin(*world, *players); !begun) return bad(begun.error());
  RlogResult<void> added;
  const auto read = store.read_log(done.first, done.last, [&](const EditRecord& record) {
    added = writer.add(record);
    ++done.edits;
    return added.has_value();
  });
  if (!read) return failure(read.error().message());
  if (!added) return bad(added.error());
  if (done.edits != done.last + 1 - done.first)
    return failure(store.file() + ": was shortened by retention meanwhile: export it again");
  if (const auto finished = writer.finish(); !finished) return bad(finished.error());
  done.bytes = writer.bytes();
  return done;
}

/// Writes edits and players of a file to a world, one transaction at a time.
class Importer {
 public:
  Importer(Store& store, std::string file) : store_(store), file_(std::move(file)) {}

  /// Compares players and the ends of both logs. New players are written with the first edits.
  Result<void, std::string> begin(const RlogReader& reader) {
    const auto rows = store_.players();
    if (!rows) return failure(rows.error().message());
    std::map<AuthorId, PublicKey> known;
    for (const PlayerRow& row : *rows) known.emplace(row.author, row.key);
    for (const RlogPlayer& player : reader.players()) {
      const auto found = known.find(player.author);
      if (found == known.end()) {
        players_.push_back({player.author, player.key, player.name});
      } else if (found->second != player.key) {
        return failure(file_ + ": author " + std::to_string(player.author) +
                       " is another player than in " + store_.file());
      }
    }
    const auto range = store_.log_range();
    if (!range) return failure(range.error().message());
    range_ = *range;
    const LogEnd head{reader.world().head, reader.world().head_us};
    const Sequence end = range_.last.version.seq;
    if (head.version.seq > end || (head.version.seq == end && head != range_.last)) {
      return failure(file_ + ": continues after edit " + std::to_string(head.version.seq) +
                     " of epoch " + std::to_string(head.version.epoch) + ", but the log of " +
                     store_.file() + " ends with edit " + std::to_string(end) + " of epoch " +
                     std::to_string(range_.last.version.epoch));
    }
    return {};
  }
  /// Adds an edit to the batch and writes a full batch. Returns false after an error.
  bool add(const EditRecord& record) {
    batch_.push_back(record);
    return batch_.size() < kEditsPerTransaction || flush();
  }
  /// Writes the batch. Returns false after an error.
  bool flush() {
    if (!error_.empty()) return false;
    std::span<const EditRecord> rest(batch_);
    const auto split = [&](Sequence behind) {  // takes the edits before a sequence
      std::size_t count = 0;
      while (count < rest.size() && rest[count].version.seq < behind) ++count;
      const auto part = rest.first(count);
      rest = rest.subspan(count);
      return part;
    };
    report_.compacted += split(range_.first).size();
    const auto known = split(range_.last.version.seq + 1);
    if (!compare(known)) return false;
    report_.known += known.size();
    if (!rest.empty() || !players_.empty()) {
      if (const auto done = store_.append_history(players_, rest); !done)
        error_ = done.error().message();
      if (error_.empty()) report_.added += rest.size();
      players_.clear();
    }
    batch_.clear();
    return error_.empty();
  }
  const std::string& error() const { return error_; }
  const RlogImport& report() const { return report_; }

 private:
  bool compare(std::span<const EditRecord> known) {
    if (known.empty()) return true;
    std::size_t at = 0;
    const auto read = store_.read_log(
        known.front().version.seq, known.back().version.seq,
        [&](const EditRecord& record) { return record == known[at] && ++at < known.size(); });
    if (!read) {
      error_ = read.error().message();
    } else if (at < known.size()) {
      error_ = file_ + ": edit " + std::to_string(known[at].version.seq) +
               " is another one than in " + store_.file() + ": they are two histories";
    }
    return error_.empty();
  }

  Store& store_;
  std::string file_, error_;
  std::vector<PlayerRow> players_;
  LogRange range_;  // before the import
  std::vector<EditRecord> batch_;
  RlogImport report_;
};

Result<std::unique_ptr<Store>, std::string> existing_world(const std::string& place,
                                                           const std::string& file,
                                                           const RlogWorld& wanted) {
  // The file may hold the very edits that the world has lost.
  auto store = open_world(place, StoreAccess::repair);
  if (!store) return failure(store.error().message());
  if ((*store)->meta().world_id != wanted.world_id) return failure(file + ": is of another world");
  return *std::move(store);
}

Result<WorldMeta, std::string> meta_of_new_world(const std::string& file, const RlogWorld& wanted) {
  if (wanted.has_base || wanted.head.seq != 0) {
    return failure(file + ": does not hold its whole world (" +
                   (wanted.has_base ? "there are base chunks that no generator makes"
                                    : "it begins after edit " + std::to_string(wanted.head.seq)) +
                   "): import it into a copy of the world's folder");
  }
  auto materials = parse_material_table(wanted.materials, file);
  if (!materials) return failure(materials.error().message());
  WorldMeta meta;
  draw_identity(meta);
  meta.world_id = wanted.world_id;
  meta.chunk_edge = wanted.chunk_edge;
  meta.generator = wanted.generator;
  meta.materials = *std::move(materials);
  meta.spawn = {wanted.spawn[0], wanted.spawn[1], wanted.spawn[2]};
  const auto generator = make_generator(meta.generator, meta.materials);
  if (!generator)
    return failure(file + ": generator " + meta.generator.name + ": " + generator.error().what);
  return meta;
}

Result<RlogImport, std::string> import_into(Store& store, RlogReader& reader,
                                            const std::string& file) {
  Importer importer(store, file);
  if (const auto begun = importer.begin(reader); !begun) return failure(begun.error());
  const auto read = reader.read(1, [&](const EditRecord& record) { return importer.add(record); });
  if (!importer.flush()) return failure(importer.error());
  RlogImport report = importer.report();
  const auto last = store.last_sequence();
  if (!last) return failure(last.error().message());
  report.last = *last;
  if (!read) report.stopped = file + ": " + read.error().message();
  return report;
}

/// Makes the world of a file. A folder gets its world when the import is complete.
Result<RlogImport, std::string> import_new(const RlogImportRequest& request, RlogReader& reader,
                                           std::ostream& out) {
  const auto meta = meta_of_new_world(request.file, reader.world());
  if (!meta) return failure(meta.error());
  std::optional<NewFolder> folder;
  if (!is_database(request.place)) {
    auto made = NewFolder::make(request.place, out);
    if (!made) return failure(made.error());
    folder.emplace(*std::move(made));
  }
  auto store = create_world(folder ? folder->path() : request.place, *meta);
  if (!store) return failure(store.error().message());
  auto report = import_into(**store, reader, request.file);
  if (!report) return report;
  report->made_world = true;
  if (!folder) return report;
  if (!report->stopped.empty() && !request.until_damage) {
    return failure(report->stopped + ". No world was made: --until-damage makes one of the " +
                   std::to_string(report->added) + " edits before it");
  }
  store->reset();
  if (const auto finished = folder->finish("world.sqlite"); !finished)
    return failure(finished.error());
  return report;
}

}  // namespace

Result<RlogExport, std::string> export_rlog(WorldReader& store, const std::string& file,
                                            Sequence at, RlogOptions options) {
  auto out = open_output_file(file, kFileMode);
  if (!out) return failure(out.error());
  auto done = write_rlog(store, *out, file, at, options);
  if (!done && out->error().empty()) return done;
  if (const auto finished = out->finish(); !finished)
    return failure(file + ": cannot be written: " + finished.error());
  return done;
}

Result<RlogImport, std::string> import_rlog(const RlogImportRequest& request, std::ostream& out) {
  if (sodium_init() < 0) return failure("libsodium cannot start");
  // A pipe cannot be read from its middle, and opening one waits for its other end.
  if (const auto kind = check_file_kind(request.file); !kind) return failure(kind.error());
  const File in(request.file);
  if (!in.is_open()) return failure(request.file + ": cannot be read: " + system_error_text());
  auto reader = RlogReader::open([&in](std::uint64_t position, std::span<std::uint8_t> bytes) {
    return in.read(position, bytes);
  });
  if (!reader) return failure(request.file + ": " + reader.error().message());
  if (!has_world(request.place)) return import_new(request, *reader, out);
  auto store = existing_world(request.place, request.file, reader->world());
  if (!store) return failure(store.error());
  return import_into(**store, *reader, request.file);
}

}  // namespace runstone
