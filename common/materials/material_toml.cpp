// Reads the text form of a material table. The only file of this module that includes a TOML
// library.
#include <toml++/toml.h>

#include <charconv>
#include <initializer_list>
#include <optional>
#include <string>

#include "common/materials/material_names.hpp"
#include "common/materials/material_table.hpp"
#include "common/shapes/shape_faces.hpp"
#include "common/shapes/shape_kinds.hpp"
#include "common/shapes/shape_states.hpp"

namespace runstone {

namespace {

/// The first error is kept. The results of later reads are not used.
class TableReader {
 public:
  explicit TableReader(std::string_view file) : file_(file) {}

  bool failed() const { return error_.has_value(); }
  Unexpected<TextError> error() const { return {*error_}; }

  void reject(const toml::node& node, std::string key, std::string what) {
    reject_line(static_cast<std::uint32_t>(node.source().begin.line), std::move(key),
                std::move(what));
  }
  void reject_line(std::uint32_t line, std::string key, std::string what) {
    if (!error_) error_ = TextError{file_, line, std::move(key), std::move(what)};
  }

  void only_keys(const toml::table& table, const std::string& path,
                 std::initializer_list<std::string_view> known) {
    for (const auto& [key, node] : table) {
      bool found = false;
      for (const auto name : known) found = found || key.str() == name;
      if (!found) {
        reject_line(static_cast<std::uint32_t>(key.source().begin.line),
                    path + "." + std::string(key.str()), "unknown key");
      }
    }
  }

  std::optional<std::string> text(const toml::table& table, const std::string& path,
                                  std::string_view key) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return std::nullopt;
    if (const auto* value = node->as_string()) return value->get();
    reject(*node, path + "." + std::string(key), "must be a string");
    return std::nullopt;
  }

  double number(const toml::table& table, const std::string& path, std::string_view key,
                double otherwise) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return otherwise;
    if (const auto* value = node->as_floating_point()) return value->get();
    if (const auto* value = node->as_integer()) return static_cast<double>(value->get());
    reject(*node, path + "." + std::string(key), "must be a number");
    return otherwise;
  }

  std::array<std::uint8_t, 4> colour(const toml::table& table, const std::string& path) {
    const auto written = text(table, path, "colour");
    std::array<std::uint8_t, 4> out{0, 0, 0, 255};
    if (!written) {
      reject(table, path + ".colour", "is missing");
      return out;
    }
    const std::string& s = *written;
    bool good = (s.size() == 7 || s.size() == 9) && s[0] == '#';
    for (std::size_t i = 1; good && i < s.size(); i += 2) {
      const auto [end, status] = std::from_chars(&s[i], &s[i] + 2, out[i / 2], 16);
      good = status == std::errc{} && end == &s[i] + 2;
    }
    if (!good)
      reject(*table.get("colour"), path + ".colour", "must be \"#rrggbb\" or \"#rrggbbaa\"");
    return out;
  }

  Visibility visibility(const toml::table& table, const std::string& path) {
    const auto written = text(table, path, "visibility");
    if (!written) return Visibility::opaque;
    for (std::uint8_t i = 0; i < 3; ++i) {
      if (*written == kVisibilityNames[i]) return static_cast<Visibility>(i);
    }
    reject(*table.get("visibility"), path + ".visibility",
           R"(must be "empty", "opaque" or "transparent")");
    return Visibility::opaque;
  }

  MaterialBody body(const toml::table& table, const std::string& path) {
    const auto written = text(table, path, "body");
    if (!written) return MaterialBody::solid;
    for (std::uint8_t i = 0; i < 3; ++i) {
      if (*written == kBodyNames[i]) return static_cast<MaterialBody>(i);
    }
    reject(*table.get("body"), path + ".body", R"(must be "solid", "liquid" or "passable")");
    return MaterialBody::solid;
  }

  std::uint8_t share(const toml::table& table, const std::string& path, std::string_view key,
                     std::uint8_t otherwise) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return otherwise;
    const auto* value = node->as_integer();
    if (value != nullptr && value->get() >= 0 && value->get() <= kLookShareMax)
      return static_cast<std::uint8_t>(value->get());
    reject(*node, path + "." + std::string(key), "must be an integer of 0 .. 100 (percent)");
    return otherwise;
  }

  MaterialPattern pattern(const toml::table& table, const std::string& path) {
    const auto written = text(table, path, "pattern");
    if (!written) return MaterialPattern::none;
    std::string names;
    for (std::uint8_t i = 0; i < kMaterialPatterns; ++i) {
      if (*written == kPatternNames[i]) return static_cast<MaterialPattern>(i);
      names += (i == 0 ? "" : ", ") + std::string(kPatternNames[i]);
    }
    reject(*table.get("pattern"), path + ".pattern", "must be one of " + names);
    return MaterialPattern::none;
  }

  std::optional<MaterialLook> look(const toml::table& table, const std::string& path) {
    const toml::node* node = table.get("look");
    if (node == nullptr) return std::nullopt;
    const std::string here = path + ".look";
    const toml::table* keys = node->as_table();
    if (keys == nullptr) {
      reject(*node, here, "must be a table");
      return std::nullopt;
    }
    only_keys(*keys, here, {"variation", "grain", "roughness", "emission", "pattern"});
    MaterialLook out;
    out.variation = share(*keys, here, "variation", out.variation);
    out.grain = share(*keys, here, "grain", out.grain);
    out.roughness = share(*keys, here, "roughness", out.roughness);
    out.emission = share(*keys, here, "emission", out.emission);
    out.pattern = pattern(*keys, here);
    return out;
  }

  /// Reads the boxes of a shape, each an array of six integers.
  void boxes(const toml::node& node, const std::string& path, Shape& out) {
    const toml::array* list = node.as_array();
    if (list == nullptr || list->empty() || list->size() > kShapeBoxesMax)
      return reject(node, path, "must be an array of 1 .. 32 boxes");
    for (const toml::node& written : *list) {
      const toml::array* numbers = written.as_array();
      ShapeBox box;
      bool good = numbers != nullptr && numbers->size() == 6;
      for (std::size_t i = 0; good && i < 6; ++i) {
        const auto* value = (*numbers)[i].as_integer();
        good = value != nullptr && value->get() >= 0 && value->get() <= kShapeUnits;
        if (good) (i < 3 ? box.min : box.max)[i % 3] = static_cast<std::uint8_t>(value->get());
      }
      for (std::size_t axis = 0; axis < 3; ++axis) good = good && box.min[axis] < box.max[axis];
      if (!good) {
        return reject(
            written, path,
            "a box must be [min x, min y, min z, max x, max y, max z], integers of 0 .. 16 "
            "(sixteenths of a voxel), each min below its max");
      }
      out.boxes.push_back(box);
    }
  }

  /// Reads the keys `shape` and `crossed`. `name` is that of the material: its states say how a
  /// built-in kind lies.
  Shape shape(const toml::table& table, const std::string& path, std::string_view name) {
    const toml::node* node = table.get("shape");
    const toml::node* crossed = table.get("crossed");
    Shape out;
    if (node != nullptr && crossed != nullptr) {
      reject(*crossed, path + ".crossed", "the material has a key shape; give one of the two");
    } else if (crossed != nullptr) {
      out.form = ShapeForm::crossed;
      boxes(*crossed, path + ".crossed", out);
    } else if (node != nullptr && node->is_string()) {
      const std::string& kind = node->as_string()->get();
      if (const auto found = shape_of_kind(kind, states_in_name(name))) return *found;
      std::string names;
      for (const std::string_view known : shape_kinds())
        names.append(names.empty() ? "" : ", ").append(known);
      reject(*node, path + ".shape", "must be boxes or one of " + names);
    } else if (node != nullptr) {
      boxes(*node, path + ".shape", out);
    }
    if (failed() || out.is_cube()) return {};
    if (const auto sound = check_shape(out); !sound)
      reject(node != nullptr ? *node : *crossed, path + (node != nullptr ? ".shape" : ".crossed"),
             sound.error().what);
    return out;
  }

  std::optional<SurfaceRule> surface(const toml::table& table, const std::string& path,
                                     std::string_view key) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return std::nullopt;
    const std::string here = path + "." + std::string(key);
    const toml::table* rule = node->as_table();
    if (rule == nullptr) {
      reject(*node, here, "must be a table");
      return std::nullopt;
    }
    only_keys(*rule, here, {"seed", "elevation", "distance", "frequency"});
    SurfaceRule out;
    if (const toml::node* seed = rule->get("seed")) {
      const auto* value = seed->as_integer();
      if (value == nullptr || value->get() < INT32_MIN || value->get() > INT32_MAX) {
        reject(*seed, here + ".seed", "must be an integer of 32 bits");
      } else {
        out.seed = static_cast<std::int32_t>(value->get());
      }
    }
    out.elevation = number(*rule, here, "elevation", out.elevation);
    out.distance = number(*rule, here, "distance", out.distance);
    out.frequency = number(*rule, here, "frequency", out.frequency);
    return out;
  }

  std::optional<GenerationRule> generation(const toml::table& table, const std::string& path) {
    const toml::node* node = table.get("generate");
    if (node == nullptr) return std::nullopt;
    const std::string here = path + ".generate";
    const toml::table* rules = node->as_table();
    if (rules == nullptr) {
      reject(*node, here, "must be a table");
      return std::nullopt;
    }
    only_keys(*rules, here, {"surface", "reversed"});
    GenerationRule out;
    if (const auto rule = surface(*rules, here, "surface")) {
      out.surface = *rule;
    } else {
      reject(*rules, here + ".surface", "is missing");
    }
    out.reversed = surface(*rules, here, "reversed");
    return out;
  }

 private:
  std::string file_;
  std::optional<TextError> error_;
};

/// Reads a row without the checks of MaterialTable::add().
MaterialInfo read_info(TableReader& in, const toml::table& row, const std::string& path) {
  in.only_keys(row, path,
               {"name", "colour", "visibility", "body", "look", "shape", "crossed", "generate"});
  const auto name = in.text(row, path, "name");
  if (!name) in.reject(row, path + ".name", "is missing");
  MaterialInfo info;
  info.visibility = in.visibility(row, path);
  info.body = in.body(row, path);
  // A material that is never drawn needs no colour.
  if (info.visibility != Visibility::empty || row.contains("colour")) {
    info.colour = in.colour(row, path);
  } else {
    info.colour = {0, 0, 0, 0};
  }
  info.look = in.look(row, path);
  info.generation = in.generation(row, path);
  if (name) info.name = *name;
  info.shape = in.shape(row, path, info.name);
  if (info.visibility == Visibility::empty) {
    for (const char* key : {"shape", "crossed"}) {
      if (const toml::node* node = row.get(key))
        in.reject(*node, path + "." + key, "a material that is empty has no shape");
    }
  }
  return info;
}

void read_row(TableReader& in, const toml::table& row, const std::string& path, bool first,
              MaterialTable& out) {
  MaterialInfo info = read_info(in, row, path);
  if (in.failed()) return;
  if (first) {
    if (info != out[kEmpty]) {
      in.reject(row, path,
                R"(the first material must be name = "air", visibility = "empty", nothing else)");
    }
    return;
  }
  if (const auto id = out.add(std::move(info)); !id) in.reject(row, path, id.error().what);
}

std::string path_of(std::size_t number) { return "material[" + std::to_string(number) + "]"; }

/// Calls act(row, number) for the `[[material]]` tables of a text, until `in` has failed.
template <class Act>
void for_each_row(TableReader& in, std::string_view text, Act act) {
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error& bad) {
    return in.reject_line(static_cast<std::uint32_t>(bad.source().begin.line), "",
                          std::string(bad.description()));
  }
  for (const auto& [key, node] : root) {
    if (key.str() != "material") {
      return in.reject_line(static_cast<std::uint32_t>(key.source().begin.line),
                            std::string(key.str()), "unknown key");
    }
  }
  const toml::node* rows = root.get("material");
  if (rows == nullptr) return in.reject_line(0, "material", "is missing");
  if (rows->as_array() == nullptr || !rows->is_array_of_tables())
    return in.reject(*rows, "material", "must be written as [[material]] tables");
  std::size_t number = 0;
  for (const toml::node& row : *rows->as_array()) {
    act(*row.as_table(), number++);
    if (in.failed()) return;
  }
}

}  // namespace

Result<MaterialTable, TextError> parse_material_table(std::string_view toml,
                                                      std::string_view file) {
  TableReader in(file);
  MaterialTable out;
  for_each_row(in, toml, [&](const toml::table& row, std::size_t number) {
    read_row(in, row, path_of(number), number == 0, out);
  });
  if (in.failed()) return in.error();
  return out;
}

Result<std::vector<MaterialFileRow>, TextError> parse_material_rows(std::string_view toml,
                                                                    std::string_view file) {
  TableReader in(file);
  MaterialTable own;  // finds bad rows, and names that come twice
  std::vector<MaterialFileRow> out;
  for_each_row(in, toml, [&](const toml::table& row, std::size_t number) {
    const std::string path = path_of(number);
    MaterialInfo info = read_info(in, row, path);
    if (const toml::node* rule = row.get("generate"))
      in.reject(*rule, path + ".generate", "a material that is added later cannot be terrain");
    if (in.failed()) return;
    out.push_back({row_of(info), static_cast<std::uint32_t>(row.source().begin.line)});
    if (const auto id = own.add(std::move(info)); !id) in.reject(row, path, id.error().what);
  });
  if (in.failed()) return in.error();
  return out;
}

}  // namespace runstone
