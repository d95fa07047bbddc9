// MapWorld: a stored world as the map reads it: the present, which follows the log, and the moments
// of the past that were used last. It only reads, in short transactions, so that a server that runs
// the world can always move its write-ahead log into the database.
// Thread: one. Times are arguments. All functions but the const ones block on the disk.
#pragma once
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common/mesh/visibility.hpp"
#include "server/map/map_drawer.hpp"
#include "server/map/map_moment.hpp"
#include "server/map/map_rights.hpp"
#include "server/map/recent_changes.hpp"

namespace runstone {

class MapWorld {
 public:
  /// The log is not looked at again within this time.
  static constexpr TimeUs kAgeUsMax = 200'000;
  /// A world that lacks edits is opened anew after this time, because its host may have repaired it.
  /// This empties the caches, so its tiles are drawn again.
  static constexpr TimeUs kLossAgeUsMax = 60'000'000;
  /// Moments of the past that are kept.
  static constexpr std::size_t kMomentsMax = 4;

  /// `caches` must outlive the object.
  MapWorld(std::string place, MapCaches& caches) : place_(std::move(place)), caches_(caches) {}

  /// Opens the place, or brings the present up to the log. A place that holds another world than
  /// before is opened anew. Fails if the world cannot be read; then present() may not be called
  /// until a later call succeeds, and the same failure is returned within kAgeUsMax. `steady_us`
  /// and `utc_us` are the time. Fails (cancelled) if `progress` returned false.
  StoreResult<void> refresh(TimeUs steady_us, TimeUs utc_us,
                            const WorldAt::Progress& progress = {});

  // These functions require that the last refresh() succeeded.
  MapMoment& present() { return *world_->present; }
  /// Returns the moment after edit `at`, from the ones that are kept or from the disk. It is valid
  /// until the next call. Fails as MapMoment::open().
  StoreResult<MapMoment*> past(Sequence at, const WorldAt::Progress& progress);
  /// Returns the picture of a tile. Fails as MapDrawer::draw().
  StoreResult<std::shared_ptr<const std::string>> draw(
      const MapMoment& moment, const MapPlace& place,
      const MapVoxels::ShouldContinue& should_continue);
  /// Returns the highest voxel that shows in a column of voxels; it is not found if there is none.
  StoreResult<ColumnTop> top(const MapMoment& moment, std::int32_t x, std::int32_t z,
                             const MapVoxels::ShouldContinue& should_continue);
  const MapRights& rights() const { return world_->rights; }
  /// Returns the error that names the durable edits that the world lacks, or nullopt if it lacks none.
  /// The edits that are left are shown. The text names files of this machine, so it is for the host
  /// alone.
  const std::optional<StoreError>& loss() const { return world_->reader->loss(); }
  const RecentChanges& changes() const { return world_->changes; }
  const MaterialTable& materials() const { return world_->materials; }
  /// Returns tile_rules_of() the materials: with it, a version determines what is drawn.
  std::uint32_t tile_rules() const { return world_->tile_rules; }
  /// Returns the name of an author, such as "ana", or "#3" if it is not known.
  std::string name_of(AuthorId author) const;

 private:
  struct FileId {
    std::uint64_t device = 0, node = 0;
    friend bool operator==(const FileId&, const FileId&) = default;
  };
  struct Opened {
    FileId file;
    TimeUs opened_us = 0;                 // steady
    std::unique_ptr<WorldReader> reader;  // of chunks and tiles
    std::unique_ptr<Generator> generator;
    MaterialTable materials;
    MapMaterials map_materials;
    VisibilityTable visibility{{}};
    std::uint32_t tile_rules = 0;  // of the materials
    MapRights rights;
    std::map<AuthorId, std::string> names;
    RecentChanges changes;
    std::unique_ptr<MapMoment> present;
    Sequence reopen_at = 0;  // a present that has so many edits is opened anew
  };
  StoreResult<FileId> file_id() const;
  /// Returns true if the world lacked edits when it was opened, at least kLossAgeUsMax ago.
  bool has_old_loss(TimeUs steady_us) const;
  StoreResult<void> open(const FileId& file, TimeUs utc_us, const WorldAt::Progress& progress);
  /// Brings the present up to the end of the log. Opens the world anew if it is far behind.
  StoreResult<void> read_new_edits(TimeUs utc_us, const WorldAt::Progress& progress);
  StoreResult<void> open_present(Sequence at, const WorldAt::Progress& progress);
  /// Reads the materials. If others have a shape than before, empties the caches and forgets the
  /// recent changes, so that browsers ask for all tiles again.
  StoreResult<void> read_materials();
  StoreResult<void> read_names();

  const std::string place_;
  MapCaches& caches_;
  TimeUs refreshed_us_ = 0;
  std::optional<StoreError> failed_;  // why the last refresh() failed
  std::unique_ptr<Opened> world_;     // null: not open
  std::list<std::pair<Sequence, std::unique_ptr<MapMoment>>> past_;  // the most recently used first
};

}  // namespace runstone
