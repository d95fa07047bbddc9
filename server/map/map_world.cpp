#include "server/map/map_world.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <system_error>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/store/store.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

// A moment keeps the edits since the keyframe before it. When the present has so many, a newer
// keyframe is looked for.
constexpr Sequence kReopenEdits = 65'536;
// A moment that is kept is moved forward so far at most. Beyond that a keyframe is nearer.
constexpr Sequence kForwardEditsMax = 8'192;

}  // namespace

StoreResult<MapWorld::FileId> MapWorld::file_id() const {
  if (is_database(place_)) return FileId{};  // the same one for as long as it answers
  const std::string file = place_ + "/world.sqlite";
  struct stat about{};
  if (::stat(file.c_str(), &about) != 0) {
    return failure(StoreError{StoreError::Kind::io, file, "",
                              "cannot be read: " + std::generic_category().message(errno)});
  }
  return FileId{static_cast<std::uint64_t>(about.st_dev), static_cast<std::uint64_t>(about.st_ino)};
}

StoreResult<void> MapWorld::refresh(TimeUs steady_us, TimeUs utc_us,
                                    const WorldAt::Progress& progress) {
  if ((world_ != nullptr || failed_) && steady_us - refreshed_us_ < kAgeUsMax) {
    if (failed_) return failure(*failed_);
    return {};
  }
  const auto file = file_id();
  StoreResult<void> done;
  if (!file) {
    done = failure(file.error());
  } else if (world_ != nullptr && world_->file == *file && !has_old_loss(steady_us)) {
    done = read_new_edits(utc_us, progress);
    // The log may have been compacted or replaced. Then the world is opened anew.
    if (!done) done = open(*file, utc_us, progress);
  } else {
    done = open(*file, utc_us, progress);
  }
  failed_.reset();
  if (!done) {
    failed_ = done.error();
    past_.clear();  // the moments refer to the world's generator
    world_.reset();
  }
  if (world_ != nullptr && world_->opened_us == 0) world_->opened_us = steady_us;
  refreshed_us_ = steady_us;
  return done;
}

bool MapWorld::has_old_loss(TimeUs steady_us) const {
  return loss().has_value() && steady_us - world_->opened_us >= kLossAgeUsMax;
}

StoreResult<void> MapWorld::open(const FileId& file, TimeUs utc_us,
                                 const WorldAt::Progress& progress) {
  past_.clear();
  caches_.clear();
  world_ = std::make_unique<Opened>();
  world_->file = file;
  auto reader = open_world(place_, StoreAccess::read_only);
  if (!reader) return failure(reader.error());
  world_->reader = *std::move(reader);
  world_->reader->set_row_check(RowCheck::bytes);
  auto generator = generator_of(*world_->reader);
  if (!generator) {
    return failure(StoreError{StoreError::Kind::not_a_world, world_->reader->file(), "meta",
                              generator.error()});
  }
  world_->generator = *std::move(generator);
  // Rights, names and materials are read after the present was opened, so they are at least as new.
  const auto last = world_->reader->last_sequence();
  if (!last) return failure(last.error());
  if (auto opened = open_present(*last, progress); !opened) return opened;
  if (auto read = read_materials(); !read) return read;
  if (auto read = read_names(); !read) return read;
  auto rights = read_map_rights(*world_->reader, utc_us);
  if (!rights) return failure(rights.error());
  world_->rights = *std::move(rights);
  world_->changes.begin(world_->present->at());
  return {};
}

StoreResult<void> MapWorld::open_present(Sequence at, const WorldAt::Progress& progress) {
  auto present = MapMoment::open(place_, *world_->generator, at, progress);
  if (!present) return failure(present.error());
  world_->present = *std::move(present);
  world_->reopen_at = world_->present->edits_kept() + kReopenEdits;
  return {};
}

StoreResult<void> MapWorld::read_new_edits(TimeUs utc_us, const WorldAt::Progress& progress) {
  Opened& world = *world_;
  const auto last = world.reader->last_sequence();
  if (!last) return failure(last.error());
  if (*last == world.present->at()) return {};
  if (*last > world.present->at() + kReopenEdits) {
    // A newer keyframe is nearer than so many edits.
    const FileId file = world.file;
    return open(file, utc_us, progress);
  }
  bool has_rights = false, has_materials = false, has_new_author = false;
  const auto advanced = world.present->advance(
      *last,
      [&](const EditRecord& record) {
        has_rights = has_rights || record.cause == Cause::rights;
        has_materials = has_materials || record.cause == Cause::materials;
        has_new_author = has_new_author || !world.names.contains(record.op.author);
        if (!changes_voxels(record.cause)) return;
        const std::vector<ChunkCoord> chunks =
            touched_chunks(record.edit, world.reader->meta().chunk_edge);
        world.changes.add(record.version.seq, chunks);
      },
      progress);
  if (!advanced) return advanced;
  if (has_materials) {
    if (auto read = read_materials(); !read) return read;
  }
  if (has_new_author) {
    if (auto read = read_names(); !read) return read;
  }
  if (has_rights) {
    auto rights = read_map_rights(*world.reader, utc_us);
    if (!rights) return failure(rights.error());
    world.rights = *std::move(rights);
  }
  if (world.present->edits_kept() >= world.reopen_at) return open_present(*last, progress);
  return {};
}

StoreResult<void> MapWorld::read_materials() {
  auto table = world_->reader->materials();
  if (!table) return failure(table.error());
  const std::uint32_t rules = tile_rules_of(tile_shapes_number(*table));
  if (std::exchange(world_->tile_rules, rules) != rules) {
    // Materials got shapes: the same voxels look different.
    caches_.clear();
    world_->changes.begin(world_->present->at());
  }
  world_->visibility = VisibilityTable(half_filled_visibilities(*table));
  world_->map_materials = map_materials(*table);
  world_->materials = *std::move(table);
  return {};
}

StoreResult<void> MapWorld::read_names() {
  const auto players = world_->reader->players();
  if (!players) return failure(players.error());
  world_->names.clear();
  for (const PlayerRow& player : *players) world_->names[player.author] = player.name;
  world_->names[0] = "the server";
  return {};
}

StoreResult<MapMoment*> MapWorld::past(Sequence at, const WorldAt::Progress& progress) {
  for (auto kept = past_.begin(); kept != past_.end(); ++kept) {
    if (kept->first != at) continue;
    past_.splice(past_.begin(), past_, kept);
    return past_.front().second.get();
  }
  std::unique_ptr<MapMoment> moment;
  if (past_.size() >= kMomentsMax) {
    // The moment that was used least recently is advanced if few edits lie between. The button Play
    // asks for moments in this order.
    const Sequence from = past_.back().first;
    moment = std::move(past_.back().second);
    past_.pop_back();
    const bool is_near = from < at && at - from <= kForwardEditsMax &&
                         moment->edits_kept() + (at - from) <= kReopenEdits;
    if (!is_near || !moment->advance(at, [](const EditRecord&) {})) moment = nullptr;
  }
  if (moment == nullptr) {
    auto opened = MapMoment::open(place_, *world_->generator, at, progress);
    if (!opened) return failure(opened.error());
    moment = *std::move(opened);
  }
  past_.emplace_front(at, std::move(moment));
  return past_.front().second.get();
}

StoreResult<std::shared_ptr<const std::string>> MapWorld::draw(
    const MapMoment& moment, const MapPlace& place,
    const MapVoxels::ShouldContinue& should_continue) {
  MapVoxels voxels(*world_->generator, world_->visibility, world_->tile_rules, *world_->reader,
                   caches_, should_continue);
  return MapDrawer(*world_->generator, world_->map_materials, voxels, caches_).draw(moment, place);
}

StoreResult<ColumnTop> MapWorld::top(const MapMoment& moment, std::int32_t x, std::int32_t z,
                                     const MapVoxels::ShouldContinue& should_continue) {
  MapVoxels voxels(*world_->generator, world_->visibility, world_->tile_rules, *world_->reader,
                   caches_, should_continue);
  const std::int32_t edge = moment.meta().chunk_edge;
  const ColumnKey key{0, floor_div(x, edge), floor_div(z, edge)};
  const auto tops =
      MapDrawer(*world_->generator, world_->map_materials, voxels, caches_).tops(moment, key);
  if (!tops) return failure(tops.error());
  return (*tops)->at(x - key.x * edge, z - key.z * edge);
}

std::string MapWorld::name_of(AuthorId author) const {
  const auto found = world_->names.find(author);
  return found == world_->names.end() ? "#" + std::to_string(author) : found->second;
}

}  // namespace runstone
