#include "server/admin/restore_box_commands.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "common/core/utc_text.hpp"
#include "common/formats/material_match.hpp"
#include "common/rights/protected_box.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/place_words.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/history/build_at.hpp"
#include "server/history/named_moment.hpp"
#include "server/rollback/count_text.hpp"
#include "server/store/store.hpp"

namespace runstone {
namespace {

/// The greatest memory for the box of one world.
constexpr std::size_t kRestoredBytesMax = std::size_t{128} << 20;

Result<RestoreBoxCommand, std::string> parse_restore_box(WordReader& reader) {
  RestoreBoxCommand command;
  command.backup = reader.take("restore-box", "a folder with a backup");
  if (!reader.take_word("box")) {
    reader.wrong("restore-box " + command.backup + ": box X Y Z X Y Z comes after the folder");
    return reader.result(command);
  }
  command.box = reader.box("box");
  if (reader.take_word("at")) command.at_us = reader.moment("at");
  reader.expect_end("restore-box");
  if (reader.error().empty() && volume_of(command.box) > kRestoredVoxelsMax)
    reader.wrong("restore-box: the box has more than " + std::to_string(kRestoredVoxelsMax) +
                 " voxels: restore it in parts");
  return reader.result(command);
}

/// A box as it was in a backup, and the same box of the world now.
struct BackupBox {
  std::shared_ptr<const FileBuild> then;
  LogEnd end;  // of the backup, at the moment
  std::uint64_t differing = 0;
};

Result<FileBuild, std::string> read_box(WorldReader& reader, const Generator& generator,
                                        Sequence at, const VoxelBox& box, LogEnd& end,
                                        const ShouldContinue& should_continue) {
  const auto world = WorldAt::open(reader, generator, at);
  if (!world) return failure(world.error().message());
  end = world->end();
  const auto materials = reader.materials(at);
  if (!materials) return failure(materials.error().message());
  return build_at(*world, reader, *materials, box, reader.meta().chunk_edge, kRestoredBytesMax,
                  [&](std::uint64_t, std::uint64_t) { return should_continue(); });
}

/// Returns a key that distinguishes restored materials, or an empty text for an empty material.
/// place_build() finds materials by name, and a material may have got a shape since the backup.
std::string restored_name(const BuildMaterial& material) {
  return material.row.visibility == Visibility::empty ? "" : world_name_of(material);
}

/// Returns how many cells of two builds with the same cuts differ. Cost: O(cells log runs) for the
/// sections that are not the same.
std::uint64_t differing_cells(const FileBuild& then, const FileBuild& now) {
  constexpr std::int32_t kNone = -1;
  std::vector<std::int32_t> numbers(then.materials.size() + 1, kNone);  // by number then
  numbers[0] = 0;
  bool is_same_palette = then.materials.size() == now.materials.size();
  std::map<std::string, std::int32_t> now_numbers;  // by name
  for (std::size_t j = 0; j < now.materials.size(); ++j)
    now_numbers.emplace(restored_name(now.materials[j]), static_cast<std::int32_t>(j + 1));
  for (std::size_t i = 0; i < then.materials.size(); ++i) {
    const auto found = now_numbers.find(restored_name(then.materials[i]));
    if (found != now_numbers.end()) numbers[i + 1] = found->second;
    is_same_palette = is_same_palette && numbers[i + 1] == static_cast<std::int32_t>(i + 1);
  }
  std::uint64_t count = 0;
  const SectionPos counts = then.build->section_counts();
  for (SectionPos at; at.z < counts.z; ++at.z) {
    for (at.y = 0; at.y < counts.y; ++at.y) {
      for (at.x = 0; at.x < counts.x; ++at.x) {
        const RunChunk& a = *then.build->section(at);
        const RunChunk& b = *now.build->section(at);
        if (is_same_palette && a == b) continue;
        const VoxelBox cells = then.build->box_of(at);
        const VoxelPos sides{cells.max.x - cells.min.x, cells.max.y - cells.min.y,
                             cells.max.z - cells.min.z};
        for (std::int32_t z = 0; z < sides.z; ++z) {
          for (std::int32_t y = 0; y < sides.y; ++y) {
            for (std::int32_t x = 0; x < sides.x; ++x) {
              const LocalPos cell{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                                  static_cast<std::uint8_t>(z)};
              if (numbers[material_at(a, cell)] != std::int32_t{material_at(b, cell)}) ++count;
            }
          }
        }
      }
    }
  }
  return count;
}

/// Reads the box of the backup and that of the world, as it is on disk up to `durable`. Blocks on
/// the disk.
Result<BackupBox, std::string> read_backup_box(WorldReader& live, const Generator& generator,
                                               const RestoreBoxCommand& wanted, Sequence durable,
                                               const ShouldContinue& should_continue) {
  const std::string place = place_name(wanted.backup);  // without a password
  // If the file is a FIFO, opening it would block this worker for ever.
  std::error_code unreadable;
  const std::string file = wanted.backup + "/world.sqlite";
  if (!is_database(wanted.backup) && std::filesystem::exists(file, unreadable) &&
      !std::filesystem::is_regular_file(file, unreadable))
    return failure(file + ": is no regular file");
  const auto opened = open_world(wanted.backup, StoreAccess::read_only);
  if (!opened) return failure(opened.error().message());
  Store& backup = **opened;
  if (backup.meta().world_id != live.meta().world_id)
    return failure(place + ": is a backup of another world");
  if (backup.meta().chunk_edge != live.meta().chunk_edge ||
      backup.meta().generator != live.meta().generator)
    return failure(place + ": has the id of this world, but other chunks or another generator");
  const NamedMoment moment =
      wanted.at_us ? NamedMoment(AtTime{*wanted.at_us}) : NamedMoment(BeforeEnd{0});
  const auto at = sequence_of(backup, moment);
  if (!at) return failure(at.error().message());
  BackupBox out;
  auto then = read_box(backup, generator, *at, wanted.box, out.end, should_continue);
  if (!then) return failure(place + ": " + then.error());
  LogEnd ignored;
  const auto now = read_box(live, generator, durable, wanted.box, ignored, should_continue);
  if (!now) return failure(now.error());
  out.differing = differing_cells(*then, *now);
  out.then = std::make_shared<const FileBuild>(*std::move(then));
  return out;
}

void place_backup_box(const CommandCall& call, const RestoreBoxCommand& wanted,
                      const BackupBox& box) {
  const std::string moment = box.end.version.seq == 0
                                 ? std::string("before its first edit")
                                 : "after edit " + std::to_string(box.end.version.seq) + " of " +
                                       utc_text(box.end.time_us);
  const std::string place = "the box " + ground_text(wanted.box);
  if (box.differing == 0)
    return call.answer(place + " is as it was in the backup " + moment + ": nothing to restore");
  const std::string what = place + " would become as it was in the backup " + moment + ": " +
                           counted(box.differing, "voxel") +
                           " would change, also where players have built since";
  const std::size_t missing =
      match_by_name(box.then->materials, call.world().order().materials()).missing.size();
  const std::string added =
      missing == 0 ? "" : "; this world would get " + counted(missing, "material") + " for ever";
  if (call.refuse_unless_confirmed(what + added)) return;
  PlaceWords words;
  words.at = wanted.box.min;
  words.missing = MissingMaterials::added;
  place_build(call, "restore-box", place, box.then, words);
}

void restore_box(const CommandCall& call, const RestoreBoxCommand& wanted) {
  call.world().commit(call.now);
  const Sequence durable = call.world().order().durable();
  auto found = std::make_shared<Result<BackupBox, std::string>>(BackupBox{});
  call.services.workers.run(
      [found, wanted, durable, should_continue = call.services.rollback.should_continue()](
          WorldReader& reader, const Generator& generator) {
        *found = read_backup_box(reader, generator, wanted, durable, should_continue);
      },
      [found, call, wanted](const std::string& error) {
        if (!error.empty()) return call.refuse("restore-box: " + error);
        if (!*found) return call.refuse("restore-box: " + found->error());
        place_backup_box(call, wanted, **found);
      });
}

constexpr std::array<CommandRow, 1> kRestoreBoxRows = {{
    {.words = "restore-box FILE",
     .rule = kLocal,
     .help = "restore-box FOLDER box X Y Z X Y Z [at MOMENT]\n"
             "                          make a box as it was in a backup, as an action that can be "
             "undone;\n"
             "                          without the word anyway it says what would change",
     .functions = parsed_by<parse_restore_box, restore_box>(),
     .may_be_confirmed = true},
}};

}  // namespace

std::span<const CommandRow> restore_box_commands() { return kRestoreBoxRows; }

}  // namespace runstone
