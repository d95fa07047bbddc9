#include "server/map/map_json.hpp"

#include <nlohmann/json.hpp>

#include "common/core/utc_text.hpp"
#include "server/history/edit_text.hpp"
#include "server/map/map_builders.hpp"

namespace runstone {
namespace {

using Json = nlohmann::json;

/// Names of players come from outside. Text that is no UTF-8 would make dump() throw.
std::string text_of_json(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

constexpr TimeUs kUsPerMs = 1000;

Json moment(const Sequence seq, const TimeUs time_us) {
  return {{"seq", seq}, {"time_ms", time_us / kUsPerMs}};
}

Json list_of(const MapWorld& world, std::span<const EditRecord> edits) {
  Json list = Json::array();
  for (const EditRecord& edit : edits) {
    list.push_back({{"seq", edit.version.seq},
                    {"time", utc_text(edit.time_us)},
                    {"author", world.name_of(edit.op.author)},
                    {"what", edit_text(edit, world.materials())},
                    {"undo", undo_command(edit)}});
  }
  return list;
}

}  // namespace

std::string map_state_json(MapWorld& world, const LogRange& range, const LogEnd& head,
                           std::optional<Sequence> since) {
  const MapMoment& present = world.present();
  const WorldMeta& meta = present.meta();
  const bool looks_back = world.rights().may_look_back;
  Json out{{"seq", present.at()},     {"edge", meta.chunk_edge},
           {"tile", kMapTileSide},    {"zoom_max", kMapZoomMax},
           {"look_back", looks_back}, {"spawn", {meta.spawn.x, meta.spawn.z}}};
  out["lacks_edits"] = world.loss().has_value();
  if (const auto bounds = present.ground().bounds()) {
    const std::int32_t edge = meta.chunk_edge;
    out["bounds"] = {bounds->min.x * edge, bounds->min.z * edge, bounds->max.x * edge,
                     bounds->max.z * edge};
  }
  if (looks_back) {
    out["first"] = moment(range.first - 1, head.time_us);
    out["last"] = moment(present.at(), present.end().time_us);
  }
  const RecentChanges::Answer changes = world.changes().after(since.value_or(present.at()));
  out["is_complete"] = changes.is_complete;
  Json columns = Json::array();
  for (const ChangedColumn& column : changes.columns) {
    columns.push_back({column.x, column.z});
  }
  out["changed"] = std::move(columns);
  return text_of_json(out);
}

std::string map_builders_json(const MapWorld& world, std::int32_t x, std::int32_t z,
                              const ColumnTop& top, std::span<const EditRecord> edits) {
  Json out{{"x", x}, {"z", z}};
  if (top.is_found()) {
    out["y"] = top.y;
    out["material"] = world.materials().knows(top.material) ? world.materials()[top.material].name
                                                            : std::to_string(top.material);
  }
  out["edits"] = list_of(world, edits);
  return text_of_json(out);
}

std::string map_edits_json(const MapWorld& world, std::span<const EditRecord> edits) {
  return text_of_json(list_of(world, edits));
}

std::string map_moment_json(const LogEnd& end) {
  return text_of_json(moment(end.version.seq, end.time_us));
}

}  // namespace runstone
