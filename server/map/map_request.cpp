#include "server/map/map_request.hpp"

#include <array>
#include <charconv>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

namespace runstone {
namespace {

Unexpected<MapRequestError> unknown_path() { return {{true, "there is no such page"}}; }
Unexpected<MapRequestError> refused(std::string what) { return {{false, std::move(what)}}; }

/// Parses a whole number in its only form. Returns nullopt on any other text.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
  const std::string_view digits = text.starts_with('-') ? text.substr(1) : text;
  const bool has_other_form =
      digits.empty() || (digits.size() > 1 && digits[0] == '0') || digits[0] == '-' || text == "-0";
  if (has_other_form) return std::nullopt;
  Number out{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return out;
}

/// The fields of a query: names and values that are decimal numbers, so nothing is escaped.
class QueryFields {
 public:
  /// Returns nullopt if a field has no value, occurs twice, or is not one of `names`.
  static std::optional<QueryFields> parse(std::string_view query,
                                          std::initializer_list<std::string_view> names) {
    QueryFields out;
    while (!query.empty()) {
      const std::size_t end = query.find('&');
      const std::string_view field = query.substr(0, end);
      query.remove_prefix(end == std::string_view::npos ? query.size() : end + 1);
      if (end != std::string_view::npos && query.empty()) return std::nullopt;
      const std::size_t equals = field.find('=');
      if (equals == std::string_view::npos) return std::nullopt;
      const std::string_view name = field.substr(0, equals);
      bool is_known = false;
      for (const std::string_view each : names) is_known = is_known || each == name;
      if (!is_known || out.find(name)) return std::nullopt;
      out.fields_.emplace_back(name, field.substr(equals + 1));
    }
    return out;
  }
  std::optional<std::string_view> find(std::string_view name) const {
    for (const auto& [known, value] : fields_) {
      if (known == name) return value;
    }
    return std::nullopt;
  }

 private:
  std::vector<std::pair<std::string_view, std::string_view>> fields_;
};

constexpr TimeUs kUsPerMillisecond = 1000;
constexpr const char* kBadQuery = "the query of this request is not understood";

/// Parses a sequence that may be missing. The outer nullopt means a text that is no sequence.
std::optional<std::optional<Sequence>> sequence_in(const QueryFields& fields,
                                                   std::string_view name) {
  const auto text = fields.find(name);
  if (!text) return std::optional<Sequence>();
  const auto seq = number_of<Sequence>(*text);
  if (!seq || *seq > kSequenceMax) return std::nullopt;
  return std::optional<std::optional<Sequence>>(std::in_place, seq);
}

std::string no_edit(std::string_view name) {
  return std::string(name) + " must be the number of an edit";
}

Result<MapRequest, MapRequestError> tile_request(std::string_view rest, std::string_view query) {
  std::array<std::string_view, 3> parts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t end = rest.find(i + 1 < parts.size() ? "/" : ".png");
    if (end == std::string_view::npos) return unknown_path();
    parts[i] = rest.substr(0, end);
    rest.remove_prefix(end + (i + 1 < parts.size() ? 1 : 4));
  }
  if (!rest.empty()) return unknown_path();
  const auto zoom = number_of<std::uint8_t>(parts[0]);
  const auto x = number_of<std::int32_t>(parts[1]), z = number_of<std::int32_t>(parts[2]);
  if (!zoom || !x || !z) return unknown_path();
  const MapPlace place{*zoom, *x, *z};
  if (place.zoom > kMapZoomMax)
    return refused("zoom is a number from 0 to " + std::to_string(kMapZoomMax));
  if (!is_in_world(place)) return refused("this tile lies outside of the world");
  const auto fields = QueryFields::parse(query, {"at"});
  if (!fields) return refused(kBadQuery);
  const auto at = sequence_in(*fields, "at");
  if (!at) return refused(no_edit("at"));
  return MapRequest(TilePictureRequest{place, *at});
}

Result<MapRequest, MapRequestError> state_request(std::string_view query) {
  const auto fields = QueryFields::parse(query, {"since"});
  if (!fields) return refused(kBadQuery);
  const auto since = sequence_in(*fields, "since");
  if (!since) return refused(no_edit("since"));
  return MapRequest(MapStateRequest{*since});
}

Result<MapRequest, MapRequestError> builders_request(std::string_view query) {
  const auto fields = QueryFields::parse(query, {"x", "z", "at"});
  if (!fields || !fields->find("x") || !fields->find("z")) return refused(kBadQuery);
  const auto in_world = [](const std::optional<std::int32_t>& n) {
    return n && *n >= -kWorldLimit && *n < kWorldLimit;
  };
  const auto x = number_of<std::int32_t>(*fields->find("x"));
  const auto z = number_of<std::int32_t>(*fields->find("z"));
  if (!in_world(x) || !in_world(z)) return refused("x and z must be a place in the world");
  const auto at = sequence_in(*fields, "at");
  if (!at) return refused(no_edit("at"));
  return MapRequest(BuildersRequest{*x, *z, *at});
}

Result<MapRequest, MapRequestError> moment_request(std::string_view query) {
  const auto fields = QueryFields::parse(query, {"seq", "time_ms"});
  if (!fields || fields->find("seq").has_value() == fields->find("time_ms").has_value())
    return refused(kBadQuery);
  if (fields->find("seq")) {
    const auto seq = sequence_in(*fields, "seq");
    if (!seq) return refused(no_edit("seq"));
    return MapRequest(MapMomentRequest{**seq});
  }
  const auto time_ms = number_of<TimeUs>(*fields->find("time_ms"));
  const bool is_time = time_ms && *time_ms >= 0 &&
                       *time_ms <= std::numeric_limits<TimeUs>::max() / kUsPerMillisecond;
  if (!is_time) return refused("time_ms must be milliseconds since 1970");
  return MapRequest(MapMomentRequest{*time_ms * kUsPerMillisecond});
}

}  // namespace

Result<MapRequest, MapRequestError> parse_map_request(std::string_view path,
                                                      std::string_view query) {
  constexpr std::string_view kTile = "tile/";
  if (!path.starts_with(kMapDataPath)) return unknown_path();
  if (path == kRecentEditsPath || path == kMapRightsPath) {
    if (!query.empty()) return refused(kBadQuery);
    return path == kRecentEditsPath ? MapRequest(RecentEditsRequest{})
                                    : MapRequest(RightsRequest{});
  }
  path.remove_prefix(kMapDataPath.size());
  if (path.starts_with(kTile)) return tile_request(path.substr(kTile.size()), query);
  if (path == "state.json") return state_request(query);
  if (path == "builders.json") return builders_request(query);
  if (path == "moment.json") return moment_request(query);
  return unknown_path();
}

}  // namespace runstone
