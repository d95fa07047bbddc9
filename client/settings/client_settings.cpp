#include "client/settings/client_settings.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <array>
#include <functional>
#include <map>
#include <utility>

#include "client/render/antialiasing.hpp"
#include "client/settings/toml_text.hpp"
#include "common/core/text.hpp"
#include "common/core/tile_keys.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

constexpr std::array<const char*, kQualityChoiceCount> kQualityNames = {"automatic", "low",
                                                                        "medium", "high"};

/// Sets one field from a node. Returns an empty text, or what is wrong with the node.
using SetField = std::function<std::string(const toml::node&, ClientSettings&)>;

template <class Number>
SetField number_field(Number ClientSettings::* field, double least, double most) {
  return [=](const toml::node& node, ClientSettings& out) -> std::string {
    const auto value = node.value<double>();
    const bool is_right =
        node.is_number() && (node.is_integer() || std::is_floating_point_v<Number>);
    if (!value || !is_right || !(*value >= least && *value <= most)) {
      return fmt::format("must be {} from {} to {}",
                         std::is_floating_point_v<Number> ? "a number" : "a whole number", least,
                         most);
    }
    out.*field = static_cast<Number>(*value);
    return {};
  };
}

SetField switch_field(bool ClientSettings::* field) {
  return [=](const toml::node& node, ClientSettings& out) -> std::string {
    if (!node.is_boolean()) return "must be true or false";
    out.*field = node.as_boolean()->get();
    return {};
  };
}

std::string set_name(const toml::node& node, ClientSettings& out) {
  const auto* const text = node.as_string();
  if (text == nullptr || text->get().size() > kPlayerNameBytesMax || !is_plain_name(text->get()))
    return "must be a text of 1 to 32 bytes without quotes, backslashes and unseen characters";
  out.name = text->get();
  return {};
}

std::string set_key_file(const toml::node& node, ClientSettings& out) {
  const auto* const text = node.as_string();
  const bool is_path = text != nullptr && is_printable_utf8(text->get()) &&
                       (text->get().empty() || text->get()[0] == '/');
  if (!is_path) return "must be the path of a file that begins with /, or empty";
  out.key_file = text->get();
  return {};
}

std::string set_quality(const toml::node& node, ClientSettings& out) {
  const auto text = node.value<std::string>();
  for (std::size_t i = 0; i < kQualityNames.size(); ++i) {
    if (text != kQualityNames[i]) continue;
    out.quality = static_cast<QualityChoice>(i);
    return {};
  }
  return R"(must be "automatic", "low", "medium" or "high")";
}

std::string set_antialiasing(const toml::node& node, ClientSettings& out) {
  const auto text = node.value<std::string>();
  const auto antialiasing = text ? parse_antialiasing(*text) : std::nullopt;
  if (!antialiasing) return R"(must be "auto", "off", "fxaa" or "msaa")";
  out.antialiasing = *antialiasing;
  return {};
}

std::string set_memory(const toml::node& node, ClientSettings& out) {
  const auto mib = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
  const bool is_automatic = mib == 0;
  if (!mib || (!is_automatic &&
               (*mib < std::int64_t{kMemoryMibMin} || *mib > std::int64_t{kMemoryMibMax}))) {
    return fmt::format("must be 0 or a whole number from {} to {}", kMemoryMibMin, kMemoryMibMax);
  }
  out.memory_mib = static_cast<std::uint64_t>(*mib);
  return {};
}

/// Returns the fields by section and key. The section of the topmost keys has no name.
const std::map<std::pair<std::string, std::string>, SetField>& fields() {
  static const auto kFields = [] {
    using S = ClientSettings;
    return std::map<std::pair<std::string, std::string>, SetField>{
        {{"", "name"}, set_name},
        {{"", "key_file"}, set_key_file},
        {{"view", "quality"}, set_quality},
        {{"view", "antialiasing"}, set_antialiasing},
        {{"view", "field_of_view"}, number_field(&S::field_of_view, 30, 110)},
        {{"view", "radius"}, number_field(&S::view_radius, 1, kViewRadiusMax)},
        {{"view", "far_levels"}, number_field(&S::far_levels, 0, kTileLevelMax)},
        {{"view", "memory_mib"}, set_memory},
        {{"view", "textures"}, switch_field(&S::shows_textures)},
        {{"hand", "sensitivity"}, number_field(&S::sensitivity, 0.1, 10)},
        {{"hand", "invert_y"}, switch_field(&S::invert_y)},
        {{"hand", "walks"}, switch_field(&S::walks)},
        {{"others", "show_previews"}, switch_field(&S::shows_previews)},
        {{"others", "share_previews"}, switch_field(&S::shares_previews)},
        {{"interface", "scale"}, number_field(&S::interface_scale, 0.5, 4)},
    };
  }();
  return kFields;
}

bool is_section(std::string_view name) {
  return name == "view" || name == "hand" || name == "others" || name == "interface" ||
         name == "keys";
}

/// Collects the warnings of one file.
class Reader {
 public:
  Reader(const std::string& file, ReadSettings& out) : file_(file), out_(out) {}

  void warn(toml::source_index line, const std::string& what) {
    out_.warnings.push_back(fmt::format("{}:{}: {}", file_, line, what));
  }

  void read_section(const toml::table& table, const std::string& section) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      const std::string path = section.empty() ? name : section + "." + name;
      const auto line = key.source().begin.line;
      if (section.empty() && is_section(name)) {
        if (node.is_table()) {
          read_section(*node.as_table(), name);
        } else {
          warn(line, path + ": must be a table");
        }
        continue;
      }
      const auto field = fields().find({section, name});
      if (section == "keys") {
        read_key(name, node, line);
      } else if (field == fields().end()) {
        warn(line, path + ": unknown key");
      } else if (const std::string wrong = field->second(node, out_.settings); !wrong.empty()) {
        warn(line, path + ": " + wrong);
      }
    }
  }

 private:
  void read_key(const std::string& action, const toml::node& node, toml::source_index line) {
    const auto* const text = node.as_string();
    if (text != nullptr && is_printable_utf8(text->get()) && is_printable_utf8(action)) {
      out_.settings.keys[action] = text->get();
    } else {
      warn(line, "keys." + action + ": must be a text with names of keys");
    }
  }

  const std::string& file_;
  ReadSettings& out_;
};

}  // namespace

const char* name_of(QualityChoice quality) {
  return kQualityNames.at(static_cast<std::size_t>(quality));
}

ReadSettings read_settings(std::string_view toml, const std::string& file) {
  ReadSettings out;
  Reader reader(file, out);
  try {
    reader.read_section(toml::parse(toml), "");
  } catch (const toml::parse_error& bad) {
    out = {};
    out.is_broken = true;
    reader.warn(bad.source().begin.line, std::string(bad.description()));
  }
  return out;
}

std::string to_toml(const ClientSettings& settings) {
  const ClientSettings& s = settings;
  std::string out =
      "# Settings of runstone-client, which writes this file when a setting is changed in its\n"
      "# window. Comments and unknown keys are then lost. Options of the command line win.\n\n"
      "# The name that others see, 1 to 32 bytes.\n";
  out += "name = " + toml_string(s.name) + "\n";
  out += "# The file of your identity. Empty: $XDG_DATA_HOME/runstone/key.\n";
  out += "key_file = " + toml_string(s.key_file) + "\n\n[view]\n";
  out += "# automatic (what keeps the frames smooth), low, medium or high.\n";
  out += "quality = " + toml_string(name_of(s.quality)) + "\n";
  out += "# Smooth edges: auto (msaa on a GPU, unless the quality is low), off, fxaa or msaa.\n";
  out += "antialiasing = " + toml_string(to_string(s.antialiasing)) + "\n";
  out += "# Vertical field of view in degrees, 30 to 110.\n";
  out += "field_of_view = " + toml_float(s.field_of_view) + "\n";
  out += fmt::format("# Horizontal view radius in chunks, 1 to {}. The server may reduce it.\n",
                     kViewRadiusMax);
  out += fmt::format("radius = {}\n", s.view_radius);
  out += fmt::format(
      "# Levels of coarser ground beyond it, 0 to {}. Each one lets you see twice as far.\n",
      kTileLevelMax);
  out += fmt::format("far_levels = {}\n", s.far_levels);
  out +=
      fmt::format("# Memory for chunks, edits and meshes in MiB, {} to {}. 0: found by itself.\n",
                  kMemoryMibMin, kMemoryMibMax);
  out += fmt::format("memory_mib = {}\n", s.memory_mib);
  out += "# true: worlds show the pictures that they bring. false: patterns; nothing is loaded.\n";
  out += fmt::format("textures = {}\n\n[hand]\n", s.shows_textures);
  out += "# Speed of looking with the mouse, 0.1 to 10.\n";
  out += "sensitivity = " + toml_float(s.sensitivity) + "\n";
  out += "# true: moving the mouse up looks down.\n";
  out += fmt::format("invert_y = {}\n", s.invert_y);
  out += "# true: players begin on their feet. false: they begin flying.\n";
  out += fmt::format("walks = {}\n\n[others]\n", s.walks);
  out += "# true: ghosts show what other players are about to do.\n";
  out += fmt::format("show_previews = {}\n", s.shows_previews);
  out += "# true: other players see what you are about to do.\n";
  out += fmt::format("share_previews = {}\n\n[interface]\n", s.shares_previews);
  out += "# Size of text and windows, 0.5 to 4.\n";
  out += "scale = " + toml_float(s.interface_scale) + "\n\n";
  out += "# Keys that are not the default ones, such as undo = \"ctrl+Z\". F1 shows all keys.\n";
  out += "[keys]\n";
  for (const auto& [action, keys] : s.keys)
    out += toml_string(action) + " = " + toml_string(keys) + "\n";
  return out;
}

}  // namespace runstone
