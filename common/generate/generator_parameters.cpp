// The only file of this module that includes a TOML library.
#include "common/generate/generator_parameters.hpp"

#include <toml++/toml.h>

#include <optional>
#include <string>

namespace runstone {
namespace {

/// Reader and writer use the same list of fields, so that they agree. Calls visit(field) with key,
/// value, default and range for each field in canonical order.
template <class P, class Visit>
void each_field(P& p, const FlatParameters& d, Visit&& visit) {
  visit("height", p.height, d.height, kHeightMin, kHeightMax);
  visit("y_min", p.y_min, d.y_min, kHeightMin, kHeightMax);
  visit("filling_depth", p.filling_depth, d.filling_depth, 0, 1000);
  visit("surface", p.surface, d.surface, 0, 0);
  visit("filling", p.filling, d.filling, 0, 0);
  visit("ground", p.ground, d.ground, 0, 0);
}
template <class P, class Visit>
void each_field(P& p, const TerrainParameters& d, Visit&& visit) {
  visit("sea_level", p.sea_level, d.sea_level, kHeightMin, kHeightMax);
  visit("y_min", p.y_min, d.y_min, kHeightMin, kHeightMax);
  visit("water", p.water, d.water, 0, 0);
  visit("beach", p.beach, d.beach, 0, 0);
  visit("beach_height", p.beach_height, d.beach_height, -1000, 1000);
  visit("rock", p.rock, d.rock, 0, 0);
  visit("rock_level", p.rock_level, d.rock_level, kHeightMin, kHeightMax);
  visit("peak", p.peak, d.peak, 0, 0);
  visit("peak_level", p.peak_level, d.peak_level, kHeightMin, kHeightMax);
}

template <class P, class Visit>
void each_field(P& p, const LandscapeParameters& d, Visit&& visit) {
  visit("sea_level", p.sea_level, d.sea_level, kHeightMin, kHeightMax);
  visit("y_min", p.y_min, d.y_min, kHeightMin, kHeightMax);
  visit("trees", p.trees, d.trees, 0, 200);
  visit("plants", p.plants, d.plants, 0, 400);
  visit("caves", p.caves, d.caves, 0, 1);
}
template <class P, class Visit>
void each_field(P& p, const ScenarioParameters& d, Visit&& visit) {
  visit("number", p.number, d.number, 1, 37);
  visit("edge", p.edge, d.edge, 8, 128);
  visit("material", p.material, d.material, 0, 0);
}

struct FieldReader {
  const toml::table& table;
  std::size_t known = 0;
  std::optional<Error> error;

  void operator()(const char* key, std::int32_t& value, std::int32_t, std::int32_t low,
                  std::int32_t high) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    ++known;
    const auto* number = node->as_integer();
    if (number == nullptr) {
      error = Error{ErrorCode::bad_value, "a generator parameter must be an integer", 0};
    } else if (number->get() < low || number->get() > high) {
      error = Error{ErrorCode::bad_value, "a generator parameter is outside its range", 0};
    } else {
      value = static_cast<std::int32_t>(number->get());
    }
  }
  void operator()(const char* key, std::string& value, const std::string&, std::int32_t,
                  std::int32_t) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    ++known;
    if (const auto* text = node->as_string()) {
      value = text->get();
    } else {
      error = Error{ErrorCode::bad_value, "a generator parameter must be a string", 0};
    }
  }
};

struct FieldWriter {
  std::string out;

  void operator()(const char* key, std::int32_t value, std::int32_t otherwise, std::int32_t,
                  std::int32_t) {
    if (value != otherwise) out += std::string(key) + " = " + std::to_string(value) + "\n";
  }
  void operator()(const char* key, const std::string& value, const std::string& otherwise,
                  std::int32_t, std::int32_t) {
    if (value == otherwise) return;
    out += std::string(key) + " = \"";
    for (const char c : value) {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
    out += "\"\n";
  }
};

template <class P>
Result<P> parse(std::string_view text) {
  toml::table table;
  try {
    table = toml::parse(text);
  } catch (const toml::parse_error& bad) {
    return fail(ErrorCode::bad_value, "generator parameters are no TOML", bad.source().begin.line);
  }
  P out;
  FieldReader reader{table, 0, std::nullopt};
  each_field(out, P{}, reader);
  if (reader.error) return failure(*reader.error);
  if (reader.known != table.size())
    return fail(ErrorCode::bad_value, "unknown generator parameter");
  return out;
}

template <class P>
std::string write(const P& parameters) {
  FieldWriter writer;
  each_field(parameters, P{}, writer);
  return std::move(writer.out);
}

}  // namespace

Result<FlatParameters> parse_flat_parameters(std::string_view toml) {
  auto out = parse<FlatParameters>(toml);
  if (out && out->y_min > out->height) {
    return fail(ErrorCode::bad_value, "generator parameter y_min is above height");
  }
  return out;
}
Result<TerrainParameters> parse_terrain_parameters(std::string_view toml) {
  return parse<TerrainParameters>(toml);
}
Result<LandscapeParameters> parse_landscape_parameters(std::string_view toml) {
  return parse<LandscapeParameters>(toml);
}
Result<ScenarioParameters> parse_scenario_parameters(std::string_view toml) {
  return parse<ScenarioParameters>(toml);
}

std::string to_toml(const FlatParameters& parameters) { return write(parameters); }
std::string to_toml(const TerrainParameters& parameters) { return write(parameters); }
std::string to_toml(const LandscapeParameters& parameters) { return write(parameters); }
std::string to_toml(const ScenarioParameters& parameters) { return write(parameters); }

}  // namespace runstone
