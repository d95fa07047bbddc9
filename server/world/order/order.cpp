#include "server/world/order/order.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>

#include "common/core/assert.hpp"
#include "common/tiles/tile_rules.hpp"

namespace runstone {
namespace {

EditLimits limits_of(const WorldConfig& config) {
  EditLimits limits;
  limits.chunk_edge = config.chunk_edge;
  limits.material_count = config.materials.size();
  limits.heights = config.heights;
  limits.volume_max = config.edit_volume_max;
  return limits;
}

}  // namespace

Order::Order(const WorldConfig& config, const WorldStart& start, WorldEnvironment& environment,
             WorldCounters& counters, const RandomBytes& random)
    : config_(config),
      environment_(environment),
      counters_(counters),
      authority_(limits_of(config), start.log),
      checkpointer_(config.snapshots, start.checkpoint),
      materials_(config.materials),
      tile_rules_(tile_rules_of(tile_shapes_number(materials_))),
      library_(config.library, start.library),
      textures_(start.textures),
      feed_(environment, config.may_be_followed),
      durable_(start.log.last),
      clock_(start.saved.clock) {
  for (const auto& [key, version] : start.snapshots) chunks().set_saved(key, version);
  for (const PlayerRow& player : start.players) players_.restore(player);
  players_.begin_above(start.author_max);
  for (const NameClaim& claim : start.name_claims) names_.restore(claim);
  authority_.resolved().restore(start.resolved);
  std::array<std::uint8_t, sizeof own_instance_> instance{};
  random(instance);
  std::memcpy(&own_instance_, instance.data(), sizeof own_instance_);
}

/// Returns the work of large edits that the next commit may have if every session sees them. There
/// is no room while another server may own the world.
std::uint64_t Order::large_room(std::size_t sessions, TimeUs now_us) const {
  if (!environment_.owns_world()) return 0;
  return large_edits_.room(now_us) / std::max<std::size_t>(1, sessions);
}

bool Order::has_ready_edits(std::size_t sessions, TimeUs now_us) const {
  return authority_.queue().has_ready(large_room(sessions, now_us) > 0);
}

std::optional<OrderedBatch> Order::commit(LargeEdits large, std::size_t sessions,
                                          const Clocks& now) {
  auto batch = authority_.commit(
      now, large == LargeEdits::all ? kAllLargeEdits : large_room(sessions, now.steady_us));
  if (!batch) return batch;
  ++counters_.commits;
  counters_.edits_ordered += batch->records.size();
  return batch;
}

bool Order::apply_materials(const std::vector<EditRecord>& records) {
  bool has_changed = false;
  for (const EditRecord& record : records) {
    if (const AddedMaterials* added = added_materials_of(record.edit)) {
      const auto appended = materials_.append(added->first, added->rows);
      RUNSTONE_ASSERT(appended.has_value());
    } else if (const GivenShapes* shapes = given_shapes_of(record.edit)) {
      const auto given = materials_.give_shapes(shapes->rows);
      RUNSTONE_ASSERT(given.has_value());
      for (const GivenShape& row : shapes->rows) shaped_.push_back(row.material);
    } else {
      continue;
    }
    materials_seq_ = record.version.seq;
    has_changed = true;
  }
  if (has_changed) {
    authority_.set_material_count(materials_.size());
    tile_rules_ = tile_rules_of(tile_shapes_number(materials_));
  }
  return has_changed;
}

bool Order::apply_clock(const std::vector<EditRecord>& records, const Clocks& now) {
  bool is_set = false;
  for (const EditRecord& record : records) {
    const WorldTime* time = world_time_of(record.edit);
    if (time == nullptr) continue;
    clock_.set(*time, record.version.seq, now.steady_us);
    is_set = true;
  }
  return is_set;
}

void Order::append(OrderedBatch& batch) {
  std::vector<PlayerRow> players;
  for (const EditRecord& record : batch.records) {
    if (auto player = players_.take_unsaved(record.op.author))
      players.push_back(std::move(*player));
  }
  feed_.append(std::move(players), batch);
}

bool Order::set_durable(Sequence seq) {
  RUNSTONE_ASSERT(seq <= head());
  if (seq <= durable_) return false;
  durable_ = seq;
  feed_.durable(seq);
  return true;
}

void Order::forget_gone_authors(const std::set<AuthorId>& present) {
  for (const AuthorId author : std::exchange(gone_authors_, {})) {
    if (present.contains(author)) continue;
    if (has_waiting_edit(author)) {  // the row is needed when the edit is ordered
      gone_authors_.push_back(author);
      continue;
    }
    if (players_.forget_unsaved(author)) authority_.resolved().forget(author);
  }
}

std::vector<ChunkKey> Order::step_checkpointer(const Clocks& now) {
  if (is_following()) return {};  // the owner of the world writes snapshots
  if (is_stop_due(now.steady_us)) checkpointer_.abandon();
  return checkpointer_.step(authority_, durable_, now, environment_);
}

WorldMemory Order::memory() const {
  return {chunks().resident_bytes(), chunks().stack_bytes(),
          authority_.queue().bytes() + environment_.log_queued_bytes() + feed_.unwritten().bytes()};
}

void Order::begin_stop(TimeUs due_us) {
  stop_due_us_ = due_us;
  checkpointer_.finish();
}

bool Order::is_flushed() const {
  if (is_following()) return true;
  return authority_.queue().size() == 0 && durable_ == head() &&
         (checkpointer_.is_clean(authority_) || is_stop_overdue());
}

void Order::begin_owning(Sequence checkpoint, AuthorId author_max) {
  durable_ = head();
  disk_is_full_ = false;  // of the owner before; the log of this server says if it is
  checkpointer_ = Checkpointer(config_.snapshots, checkpoint);
  players_.begin_above(author_max);
}

}  // namespace runstone
