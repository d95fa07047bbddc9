// The answers of the map that are JSON. docs/server-reference.md describes their fields.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "server/map/map_world.hpp"

namespace runstone {

/// Returns the state of the map: the end of the log, what strangers may see, and the columns of
/// chunks that edits after `since` touched. Requires a world whose refresh() succeeded, and its
/// range of the log. Without the right to look back the answer has no past and no names.
std::string map_state_json(MapWorld& world, const LogRange& range, const LogEnd& head,
                           std::optional<Sequence> since);

/// Returns who built what at a column, newest first. `top` is the highest voxel that shows.
std::string map_builders_json(const MapWorld& world, std::int32_t x, std::int32_t z,
                              const ColumnTop& top, std::span<const EditRecord> edits);

/// Returns a list of edits as in map_builders_json().
std::string map_edits_json(const MapWorld& world, std::span<const EditRecord> edits);

/// Returns the sequence and the time of a moment.
std::string map_moment_json(const LogEnd& moment);

}  // namespace runstone
