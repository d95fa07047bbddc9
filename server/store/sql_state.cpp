// The part of SqlStore that stores the state that belongs to no record (SavedState), and the clock
// that the newest record has set.
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

StoreResult<std::vector<LastPlace>> SqlStore::saved_places() {
  return at_one_moment<std::vector<LastPlace>>([&] { return meta_table_.places(); });
}

StoreResult<std::optional<SavedClock>> SqlStore::saved_clock() {
  return at_one_moment<std::optional<SavedClock>>([&] { return meta_table_.clock(); });
}

StoreResult<void> SqlStore::save_state(const SavedState& state) {
  return write([&]() -> StoreResult<void> {
    // No edit depends on these rows, so a damaged one does not end the log. Damaged places are
    // replaced. A damaged clock stays until a record sets it.
    const auto is_damaged = [](const auto& row) {
      return !row && row.error().kind == StoreError::Kind::corrupt;
    };
    const auto places = meta_table_.places();
    if (!places && !is_damaged(places)) return failed(places.error());
    if (!places || state.places != *places) {
      if (auto put = meta_table_.put_places(state.places); !put) return put;
    }
    if (state.spawn) {
      if (auto put = meta_table_.put_spawn(*state.spawn); !put) return put;
    }
    const auto clock = meta_table_.clock();
    if (!clock && !is_damaged(clock)) return failed(clock.error());
    const bool is_newest = state.clock && clock && *clock &&
                           state.clock->record == (*clock)->record && state.clock != *clock;
    return is_newest ? meta_table_.put_clock(*state.clock) : StoreResult<void>();
  });
}

StoreResult<void> SqlStore::set_clock(std::span<const EditRecord> records) {
  std::optional<SavedClock> clock;
  for (const EditRecord& record : records) {
    if (const WorldTime* time = world_time_of(record.edit))
      clock = SavedClock{record.version.seq, *time};
  }
  if (!clock) return {};
  if (auto put = meta_table_.put_clock(*clock); !put) return put;
  return raise_format(kWorldFormatOfClock);
}

}  // namespace runstone
