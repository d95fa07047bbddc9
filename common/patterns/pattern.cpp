#include "common/patterns/pattern.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace runstone {
namespace {

constexpr std::array<std::string_view, 15> kKeywords = {
    "where", "is",    "on",  "under", "beside", "exposed", "above",   "below",
    "solid", "noise", "and", "or",    "not",    "y",       "distance"};

std::string name_text(const std::string& name) {
  bool is_bare = !is_pattern_keyword(name);
  for (std::size_t i = 0; i < name.size(); ++i)
    is_bare = is_bare && is_bare_name_character(name[i], i == 0);
  if (is_bare && !name.empty()) return name;
  std::string out = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

template <class T, class F>
std::string joined_texts(const std::vector<T>& items, std::string_view between, F&& text) {
  std::string out;
  for (const T& item : items) {
    if (!out.empty()) out += between;
    out += text(item);
  }
  return out;
}

std::string names_text(std::string_view word, const VoxelFilter& filter) {
  return std::string(word) + ' ' +
         joined_texts(filter.materials, " or ",
                      [](const NamedMaterial& material) { return name_text(material.name); });
}

/// Returns the words before the parts of a mix, or an empty text for a list.
std::string head_of(const Mix& mix) {
  switch (mix.kind) {
    case MixKind::clumps:
      return "noise " + std::to_string(mix.size) + ':';
    case MixKind::height:
      return "y " + std::to_string(mix.low) + ".." + std::to_string(mix.high) + ':';
    case MixKind::distance:
      return "distance " + std::to_string(mix.low) + ".." + std::to_string(mix.high) + ':';
    case MixKind::material:
    case MixKind::list:
      break;
  }
  return {};
}

std::string part_text(const Mix& part) {
  const std::string weight = part.weight == 0 ? "" : std::to_string(part.weight) + "% ";
  if (part.kind == MixKind::material) return weight + name_text(part.material.name);
  return weight + '(' + text_of(part) + ')';
}

/// Returns a filter as an operand of `and` and `not`, which bind tighter than `or`.
std::string operand_text(const VoxelFilter& filter, bool is_negated) {
  const bool needs_parentheses =
      filter.kind == FilterKind::any || (is_negated && filter.kind == FilterKind::all);
  return needs_parentheses ? '(' + text_of(filter) + ')' : text_of(filter);
}

void append_chips(std::vector<std::string>& to, std::vector<std::string> from) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

}  // namespace

std::string PatternError::message() const {
  return "column " + std::to_string(column) + ": " + what;
}

bool is_pattern_keyword(std::string_view word) {
  return std::find(kKeywords.begin(), kKeywords.end(), word) != kKeywords.end();
}

bool is_bare_name_character(char c, bool is_first) {
  const bool is_letter =
      (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c & 0x80) != 0;
  if (is_letter || is_first) return is_letter;
  return (c >= '0' && c <= '9') || c == ':' || c == '-' || c == '.' || c == '/' || c == '~';
}

std::string text_of(const Mix& mix) {
  if (mix.kind == MixKind::material) return name_text(mix.material.name);
  const std::string head = head_of(mix);
  return head + (head.empty() ? "" : " ") + joined_texts(mix.parts, ", ", part_text);
}

std::string text_of(const VoxelFilter& filter) {
  switch (filter.kind) {
    case FilterKind::is:
      return names_text("is", filter);
    case FilterKind::on:
      return names_text("on", filter);
    case FilterKind::under:
      return names_text("under", filter);
    case FilterKind::beside:
      return names_text("beside", filter);
    case FilterKind::exposed:
      return "exposed";
    case FilterKind::solid:
      return "solid";
    case FilterKind::above:
      return "above " + std::to_string(filter.number);
    case FilterKind::below:
      return "below " + std::to_string(filter.number);
    case FilterKind::noise:
      return "noise " + std::to_string(filter.number) + '%' +
             (filter.size == 1 ? "" : ' ' + std::to_string(filter.size));
    case FilterKind::all:
      return joined_texts(filter.parts, " and ",
                          [](const VoxelFilter& part) { return operand_text(part, false); });
    case FilterKind::any:
      return joined_texts(filter.parts, " or ",
                          [](const VoxelFilter& part) { return text_of(part); });
    case FilterKind::negation:
      break;
  }
  return "not " + operand_text(filter.parts.front(), true);
}

std::string text_of(const Pattern& pattern) {
  const std::string mix = text_of(pattern.mix);
  return pattern.filter ? mix + " where " + text_of(*pattern.filter) : mix;
}

std::vector<std::string> chips_of(const Mix& mix) {
  if (mix.kind == MixKind::material) return {text_of(mix)};
  std::vector<std::string> out;
  if (std::string head = head_of(mix); !head.empty()) out.push_back(std::move(head));
  for (const Mix& part : mix.parts) out.push_back(part_text(part));
  return out;
}

std::vector<std::string> chips_of(const VoxelFilter& filter) {
  if (filter.kind != FilterKind::all) return {text_of(filter)};
  std::vector<std::string> out;
  for (const VoxelFilter& part : filter.parts) out.push_back(operand_text(part, false));
  return out;
}

std::vector<std::string> chips_of(const Pattern& pattern) {
  std::vector<std::string> out = chips_of(pattern.mix);
  if (!pattern.filter) return out;
  out.emplace_back("where");
  append_chips(out, chips_of(*pattern.filter));
  return out;
}

}  // namespace runstone
