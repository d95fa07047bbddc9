#include "common/build_files/model_words.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

namespace runstone {
namespace {

constexpr std::array<std::pair<std::string_view, SurfaceMode>, 4> kSurfaceWords = {
    {{"none", SurfaceMode::none},
     {"thin", SurfaceMode::separating_6},
     {"thick", SurfaceMode::separating_26},
     {"all", SurfaceMode::conservative}}};
constexpr std::array<std::pair<std::string_view, ModelUp>, 2> kUpWords = {
    {{"y", ModelUp::y}, {"z", ModelUp::z}}};
constexpr std::array<std::pair<std::string_view, int>, 4> kTurnWords = {
    {{"0", 0}, {"90", 1}, {"180", 2}, {"270", 3}}};

template <class Value, std::size_t kCount>
std::optional<Value> value_of_word(
    const std::array<std::pair<std::string_view, Value>, kCount>& words, std::string_view text) {
  for (const auto& [name, value] : words) {
    if (name == text) return value;
  }
  return std::nullopt;
}

/// Returns the number that the whole text is, or nullopt.
template <class Number>
std::optional<Number> model_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// Takes a value, or fails with those that are expected.
template <class Value, class Field>
Result<void, std::string> take_value(const ModelWord& word, const std::optional<Value>& value,
                                     Field& field) {
  if (!value) return failure(std::string(word.values) + " is expected");
  field = *value;
  return {};
}

}  // namespace

const ModelWord* model_word(std::string_view name) {
  const auto found = std::find_if(kModelWords.begin(), kModelWords.end(),
                                  [&](const ModelWord& word) { return word.name == name; });
  return found == kModelWords.end() ? nullptr : &*found;
}

Result<void, std::string> choose_by_word(const ModelWord& word, std::string_view value,
                                         ModelChoices& choices) {
  if (word.name == kVoxelsWord.name) {
    const std::int64_t voxels = model_number<std::int64_t>(value).value_or(0);
    if (auto why = voxels_refusal(voxels); !why.empty()) return failure(std::move(why));
    choices.voxels = static_cast<std::uint32_t>(voxels);
    choices.voxels_per_metre.reset();
  } else if (word.name == kVoxelsPerMetreWord.name) {
    const double voxels = model_number<double>(value).value_or(0);
    if (auto why = voxels_per_metre_refusal(voxels); !why.empty()) return failure(std::move(why));
    choices.voxels_per_metre = voxels;
  } else if (word.name == kSurfaceWord.name) {
    return take_value(word, value_of_word(kSurfaceWords, value), choices.surface);
  } else if (word.name == kHollowWord.name) {
    choices.is_solid = false;
  } else if (word.name == kFillOverlapsWord.name) {
    choices.fills_overlaps = true;
  } else if (word.name == kUpWord.name) {
    return take_value(word, value_of_word(kUpWords, value), choices.up);
  } else {
    return take_value(word, value_of_word(kTurnWords, value), choices.quarters);
  }
  return {};
}

}  // namespace runstone
