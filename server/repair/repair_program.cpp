#include "server/repair/repair_program.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "common/os/file_lock.hpp"
#include "common/os/folder_exchange.hpp"
#include "common/os/new_folder.hpp"
#include "common/os/progress_line.hpp"
#include "server/backup/world_backup.hpp"
#include "server/history/keyframe_maker.hpp"
#include "server/repair/ground_rebuild.hpp"
#include "server/repair/world_rebuild.hpp"
#include "server/replay/replay_commands.hpp"
#include "server/replay/subcommand.hpp"
#include "server/store/sqlite_backend.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kEditsAtOnce = 1'024;

Unexpected<std::string> failed_with(const StoreError& error) { return {error.message()}; }

Result<FileLock, std::string> lock_world(const std::string& folder) {
  auto lock = FileLock::take(folder + "/world.lock");
  if (lock) return *std::move(lock);
  return failure(folder + ": " +
                 (lock.error().is_held
                      ? "another program is writing or repairing this world: stop it first"
                      : "world.lock cannot be written: " + lock.error().what));
}

/// Returns a record that adds the materials that the voxels of `edits` have and the table lacks,
/// and behind it the records of the edits.
std::vector<EditRecord> records_of(std::vector<EditDescriptor> edits, std::size_t materials,
                                   const LogEnd& last, Epoch epoch, TimeUs now_us,
                                   WorldRebuild& rebuild, RepairReport& report) {
  std::vector<EditRecord> records;
  const auto add = [&](EditDescriptor edit, Cause cause) {
    EditRecord record;
    record.version = {epoch, last.version.seq + records.size() + 1};
    record.op = rebuild.next_operation();
    record.time_us = std::max(now_us, last.time_us);
    record.cause = cause;
    record.edit = std::move(edit);
    records.push_back(std::move(record));
  };
  std::size_t needed = materials;
  for (const EditDescriptor& edit : edits)
    needed = std::max<std::size_t>(needed, material_max(edit) + 1U);
  while (materials < needed) {
    AddedMaterials added = lost_materials(materials, needed);
    materials += added.rows.size();
    report.materials_made += added.rows.size();
    add(materials_edit(std::move(added)), Cause::materials);
  }
  for (EditDescriptor& edit : edits) add(std::move(edit), Cause::console);
  return records;
}

/// Appends the edits that snapshots show and the log lacks, and makes snapshots and keyframes.
StoreResult<void> rebuild_ground(const std::string& folder, TimeUs now_us, bool always_progress,
                                 WorldRebuild& rebuild, RepairReport& report) {
  auto store = open_world(folder, StoreAccess::read_write);
  if (!store) return failure(store.error());
  auto generator = generator_of(**store);
  if (!generator) {
    return failure(StoreError{StoreError::Kind::bad_request, folder, "", generator.error()});
  }
  GroundRebuild ground(**store, **generator);
  {
    ProgressLine line("edits replayed", always_progress);
    auto read = ground.read([&](Sequence done, Sequence last) { line.show(done, last); });
    if (!read) return read;
  }
  auto edits = ground.missing_edits(report.ground);
  store->reset();
  if (auto forgotten = forget_snapshots(folder); !forgotten) return forgotten;
  store = open_world(folder, StoreAccess::read_write);
  if (!store) return failure(store.error());
  const auto epoch = (*store)->begin_branch(now_us);
  if (!epoch) return failure(epoch.error());
  report.epoch = *epoch;
  const auto range = (*store)->log_range();
  if (!range) return failure(range.error());
  const auto materials = (*store)->materials();
  if (!materials) return failure(materials.error());
  const auto records =
      records_of(std::move(edits), materials->size(), range->last, *epoch, now_us, rebuild, report);
  for (std::size_t at = 0; at < records.size(); at += kEditsAtOnce) {
    const std::span<const EditRecord> part(records.begin() + static_cast<std::ptrdiff_t>(at),
                                           std::min(kEditsAtOnce, records.size() - at));
    if (auto appended = (*store)->append({}, part); !appended) return appended;
  }
  ground.follow(records);
  if (auto saved = ground.save(**store); !saved) return saved;
  KeyframeMaker maker(**store, **generator, {});
  auto made = maker.make_due(
      [&](const KeyframeMaker::Chunks& chunks, const std::optional<Keyframe>& keyframe) {
        return (*store)->save_keyframe(chunks, keyframe);
      });
  if (!made) return made;
  return (*store)->complete_file();
}

/// Compares the world in `folder` with base and log. Fails with the difference.
Result<void, std::string> prove(const std::string& folder, std::ostream& out) {
  VerifyOptions options;
  options.common.world = folder;
  const auto code = run_verify(options, out);
  if (!code) return failure(code.error());
  if (*code != kReplayEqual) return failure("the rows above say what differs");
  return {};
}

/// Gives the repaired world the name of the damaged one, and the other files of its folder.
Result<void, std::string> put_in_place(const RepairRequest& request,
                                       const std::vector<std::string>& left_out) {
  if (const auto exchanged = exchange_folders(request.world, request.to); !exchanged) {
    return failure(request.to + ": is repaired, and cannot take the place of " + request.world +
                   ": " + exchanged.error() + ". Rename the two folders");
  }
  std::error_code error;
  std::vector<std::string> names = left_out;
  names.insert(names.begin(), {"chat.sqlite-wal", "chat.sqlite-shm"});
  for (const std::string& name : names) {
    if (!fs::exists(fs::path(request.to) / name, error)) continue;
    fs::rename(fs::path(request.to) / name, fs::path(request.world) / name, error);
    if (error) {
      return failure(request.world + ": is repaired and in place, but " + name + " stays in " +
                     request.to + ": " + error.message());
    }
  }
  return {};
}

}  // namespace

Result<void, std::string> repair(const RepairRequest& request, TimeUs now_us, std::ostream& out) {
  if (is_inside(request.to, request.world))
    return failure(request.to + ": lies in " + request.world);
  std::error_code error;
  if (!fs::exists(fs::path(request.world) / "world.sqlite", error))
    return failure(request.world + ": holds no world");
  const auto lock = lock_world(request.world);
  if (!lock) return failure(lock.error());
  auto pages = PageFile::open(request.world);
  if (!pages) return failed_with(pages.error());
  std::optional<BackupRows> backup;
  if (!request.from.empty()) {
    auto opened = BackupRows::open(request.from);
    if (!opened) return failure(opened.error());
    backup.emplace(*std::move(opened));
  }
  auto folder = NewFolder::make(request.to, out);
  if (!folder) return failure(folder.error());
  RepairReport report;
  WorldRebuild rebuild(request.world, *pages, backup ? &*backup : nullptr, now_us, report);
  {
    ProgressLine line("pages read", request.progress);
    const auto made = create_sqlite_world(
        folder->path(),
        [&](sql::Database& database) {
          return rebuild.fill(database,
                              [&](std::uint64_t done, std::uint64_t all) { line.show(done, all); });
        },
        {});
    if (!made) return failed_with(made.error());
  }
  if (const auto made = rebuild_ground(folder->path(), now_us, request.progress, rebuild, report);
      !made)
    return failed_with(made.error());
  const auto left_out = copy_configuration(request.world, folder->path());
  if (!left_out) return failure(left_out.error());
  print(report, rebuild.chunk_edge(), out);
  const auto proven = prove(folder->path(), out);
  for (const char* name : {"world.sqlite-wal", "world.sqlite-shm", "world.lock"})
    fs::remove(fs::path(folder->path()) / name, error);
  if (const auto finished = folder->finish("world.sqlite"); !finished)
    return failure(finished.error());
  if (!proven) {
    return failure(request.to + ": is not equal to its base and log: " + proven.error());
  }
  if (request.in_place) {
    if (const auto done = put_in_place(request, *left_out); !done) return done;
  }
  const std::string& repaired = request.in_place ? request.world : request.to;
  const std::string& damaged = request.in_place ? request.to : request.world;
  out << "repaired    the repaired world is " << repaired << ": start the server on it\n"
      << "keep        the damaged world is " << damaged << ": keep it until all is well\n";
  return {};
}

}  // namespace runstone
