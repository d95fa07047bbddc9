#include "server/admin/compact_program.hpp"

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <system_error>

#include "common/os/progress_line.hpp"
#include "server/history/keyframe_maker.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

constexpr TimeUs kDayUs = 86'400'000'000;

Unexpected<std::string> compaction_failure(const StoreError& error) {
  if (error.kind != StoreError::Kind::full) return {error.message()};
  return {error.message() +
          ". The disk is full: nothing was lost, and the world stands as before; "
          "make room and compact again"};
}

std::uint64_t bytes_of(const std::string& file) {
  std::error_code ignored;
  const auto bytes = std::filesystem::file_size(file, ignored);
  return ignored ? 0 : bytes;
}

}  // namespace

Result<void, std::string> compact_world(const CompactRequest& request, TimeUs now_us,
                                        std::ostream& out, const SqliteOptions& options) {
  auto opened = is_database(request.world)
                    ? open_world(request.world, StoreAccess::read_write)
                    : open_sqlite_world(request.world, StoreAccess::read_write, options);
  if (!opened) return compaction_failure(opened.error());
  Store& store = **opened;
  const auto generator = generator_of(store);
  if (!generator) return failure(generator.error());
  const auto range = store.log_range();
  if (!range) return compaction_failure(range.error());
  const TimeUs cut_us = now_us - static_cast<TimeUs>(request.keep_days) * kDayUs;
  const auto found = store.sequence_at(cut_us);
  // An earlier compaction has removed all edits that are older.
  const bool is_none_older = !found && found.error().kind == StoreError::Kind::bad_request;
  if (!found && !is_none_older) return compaction_failure(found.error());
  const Sequence at = is_none_older ? range->first - 1 : *found;
  if (at < range->first) {
    out << "nothing to compact: no edit of the log is older than " << request.keep_days
        << " days\n";
    return {};
  }
  if (request.keep_days == 0 && !request.is_confirmed) {
    return failure(
        store.file() + ": nothing has changed: --keep 0 would move " +
        std::to_string(at + 1 - range->first) + " of " +
        std::to_string(range->last.version.seq + 1 - range->first) +
        " edits of the log into the base, and they could not be seen in the past, rolled "
        "back or undone any more. To do it all the same, add --anyway");
  }
  const auto keyframes = store.keyframes();
  if (!keyframes) return compaction_failure(keyframes.error());
  const bool is_there =
      std::any_of(keyframes->begin(), keyframes->end(),
                  [&](const Keyframe& keyframe) { return keyframe.at.version.seq == at; });
  if (!is_there) {
    ProgressLine line("edits read", request.progress);
    KeyframeMaker maker(store, **generator, {});
    const auto made = maker.make_at(
        at,
        [&](const KeyframeMaker::Chunks& chunks, const std::optional<Keyframe>& keyframe) {
          return store.save_keyframe(chunks, keyframe);
        },
        [&](Sequence done, Sequence last) {
          line.show(done, last);
          return true;
        });
    if (!made) return compaction_failure(made.error());
  }
  const std::uint64_t before = bytes_of(store.file());
  if (const auto compacted = store.compact(at); !compacted)
    return compaction_failure(compacted.error());
  out << "compacted   edits " << range->first << " to " << at << " into the base, "
      << range->last.version.seq - at << " edits stay\n";
  if (!request.shrink) return {};
  if (const auto shrunk = store.shrink(); !shrunk) {
    return failure(
        shrunk.error().message() +
        ". The world is compacted and sound, but its file keeps the free space, "
        "which new edits will use; to give it back, make room for a second copy of the world and "
        "run VACUUM");
  }
  if (is_database(request.world)) return {};
  out << "file        " << before << " bytes before, " << bytes_of(store.file()) << " now\n";
  return {};
}

}  // namespace runstone
