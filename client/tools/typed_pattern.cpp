#include "client/tools/typed_pattern.hpp"

#include <utility>

#include "common/patterns/pattern_parser.hpp"

namespace runstone {
namespace {

/// Returns a text as a pattern, of which some parts may be missing.
struct PatternParts {
  std::optional<Mix> mix;
  std::optional<VoxelFilter> filter;
};

Result<PatternParts, PatternError> parts_of(const ToolText& text) {
  if (text.text.empty()) return PatternParts{};
  switch (text.kind) {
    case ToolText::Kind::mix: {
      auto mix = parse_mix(text.text);
      if (!mix) return failure(mix.error());
      return PatternParts{*std::move(mix), std::nullopt};
    }
    case ToolText::Kind::filter: {
      auto filter = parse_filter(text.text);
      if (!filter) return failure(filter.error());
      return PatternParts{std::nullopt, *std::move(filter)};
    }
    case ToolText::Kind::pattern:
    case ToolText::Kind::plain:
      break;
  }
  auto pattern = parse_pattern(text.text);
  if (!pattern) return failure(pattern.error());
  return PatternParts{std::move(pattern->mix), std::move(pattern->filter)};
}

}  // namespace

Result<TypedPattern, std::string> typed_pattern(const ToolText& text, const MaterialTable& table,
                                                const PatternFrame& frame) {
  const auto words = [&](const PatternError& error) {
    return failure(text.name + ": " + error.message());
  };
  const auto parts = parts_of(text);
  if (!parts) return words(parts.error());
  TypedPattern out;
  if (parts->mix) {
    auto mix = BoundMix::of(*parts->mix, table, frame);
    if (!mix) return words(mix.error());
    out.mix = *std::move(mix);
  }
  if (parts->filter) {
    auto filter = BoundFilter::of(*parts->filter, table, frame.seed);
    if (!filter) return words(filter.error());
    out.filter = *std::move(filter);
  }
  return out;
}

}  // namespace runstone
