// MapRequest: what a browser asks of the map, as a value. Every byte of it comes from outside.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "server/map/map_geometry.hpp"

namespace runstone {

/// A tile of the present, or after edit `at`.
struct TilePictureRequest {
  MapPlace place;
  std::optional<Sequence> at;
};

/// The state of the map, and the columns of chunks that edits after `since` touched.
struct MapStateRequest {
  std::optional<Sequence> since;
};

/// Who built what at a column of voxels, up to edit `at` or until now.
struct BuildersRequest {
  std::int32_t x = 0, z = 0;
  std::optional<Sequence> at;
};

/// The time of an edit, or the last edit that is not later than a time.
struct MapMomentRequest {
  std::variant<Sequence, TimeUs> of;
};

/// The newest edits of the whole world.
struct RecentEditsRequest {};

/// Asks if a visitor without a key may see the world now. The answer has status 200 if so, and 403
/// if not.
struct RightsRequest {};

using MapRequest = std::variant<TilePictureRequest, MapStateRequest, BuildersRequest,
                                MapMomentRequest, RecentEditsRequest, RightsRequest>;

/// The beginning of the paths of all requests.
inline constexpr std::string_view kMapDataPath = "/map/";
inline constexpr std::string_view kRecentEditsPath = "/map/recent.json";
inline constexpr std::string_view kMapRightsPath = "/map/rights.json";

/// The reason why a request is refused, as one sentence for the browser.
struct MapRequestError {
  bool is_unknown_path = false;
  std::string what;
};

/// Parses the path and the query of a request, both as the browser sent them:
///   /map/tile/ZOOM/X/Z.png[?at=SEQ]
///   /map/state.json[?since=SEQ]
///   /map/builders.json?x=X&z=Z[&at=SEQ]
///   /map/moment.json?seq=SEQ or ?time_ms=UTC
///   /map/recent.json
///   /map/rights.json
/// Numbers are decimal, without a plus, blanks or leading zeros. Fails for any other text.
Result<MapRequest, MapRequestError> parse_map_request(std::string_view path,
                                                      std::string_view query);

}  // namespace runstone
