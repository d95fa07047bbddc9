#include "common/patterns/pattern_parser.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/core/coords.hpp"
#include "common/core/material_row.hpp"
#include "common/patterns/pattern_tokens.hpp"

namespace runstone {
namespace {

/// Keeps the first mistake. After it, every token is the end, so all rules return soon.
class PatternParser {
 public:
  explicit PatternParser(const std::vector<PatternToken>& tokens) : tokens_(tokens) {}

  Pattern pattern() {
    Pattern out{mix(0), std::nullopt};
    if (takes_word("where")) out.filter = filter(0);
    finish(out.filter ? kAfterFilter : "\",\", \"where\" or the end");
    return out;
  }
  Mix whole_mix() {
    Mix out = mix(0);
    finish("\",\" or the end");
    return out;
  }
  VoxelFilter whole_filter() {
    VoxelFilter out = filter(0);
    finish(kAfterFilter);
    return out;
  }

  const std::optional<PatternError>& error() const { return error_; }

 private:
  static constexpr std::string_view kAfterFilter = "\"and\", \"or\" or the end";

  Mix mix(std::uint32_t depth) {
    Mix out;
    out.kind = MixKind::list;
    const bool is_height = is_word("y");
    if (takes_word("noise")) {
      out.kind = MixKind::clumps;
      out.size = number(1, kClumpSizeMax, "a size from 1 to 256");
      sign(":");
    } else if (takes_word("y") || takes_word("distance")) {
      out.kind = is_height ? MixKind::height : MixKind::distance;
      range(out);
      sign(":");
    }
    const bool is_gradient = out.kind == MixKind::height || out.kind == MixKind::distance;
    do {
      out.parts.push_back(part(depth, is_gradient, out.parts));
    } while (takes_sign(","));
    if (is_gradient && out.parts.size() < 2) expected("\",\" and a second material");
    if (out.kind != MixKind::list || out.parts.size() > 1) return out;
    // A list of one part is this part, whatever it weighs.
    Mix only = std::move(out.parts.front());
    only.weight = 0;
    return only;
  }

  VoxelFilter filter(std::uint32_t depth) {
    return joined(FilterKind::any, "or",
                  [&] { return joined(FilterKind::all, "and", [&] { return condition(depth); }); });
  }

  void finish(std::string_view what) {
    if (peek().kind != PatternTokenKind::end) expected(what);
  }
  const PatternToken& peek() const { return error_ ? tokens_.back() : tokens_[next_]; }
  void skip() {
    if (next_ + 1 < tokens_.size()) ++next_;
  }
  bool is_word(std::string_view word) const {
    return peek().kind == PatternTokenKind::word && peek().raw == word;
  }
  bool takes_word(std::string_view word) {
    if (!is_word(word)) return false;
    skip();
    return true;
  }
  bool takes_sign(std::string_view text) {
    if (peek().kind != PatternTokenKind::sign || peek().raw != text) return false;
    skip();
    return true;
  }
  void fail_at(std::uint32_t column, std::string what) {
    if (!error_) error_ = PatternError{column, std::move(what)};
  }
  void expected(std::string_view what) {
    const PatternToken& found = peek();
    std::string raw = found.kind == PatternTokenKind::end      ? "the end"
                      : found.kind == PatternTokenKind::quoted ? std::string(found.raw)
                                                               : '"' + std::string(found.raw) + '"';
    fail_at(found.column, "found " + std::move(raw) + " but expected " + std::string(what));
  }
  void sign(std::string_view text) {
    if (!takes_sign(text)) expected('"' + std::string(text) + '"');
  }
  std::int32_t number(std::int32_t low, std::int32_t high, std::string_view what) {
    const PatternToken& token = peek();
    if (token.kind != PatternTokenKind::number || token.number < low || token.number > high) {
      expected(what);
      return low;
    }
    skip();
    return static_cast<std::int32_t>(token.number);
  }
  void range(Mix& out) {
    constexpr std::string_view kWhat = "a number within the world";
    const std::int32_t lowest = out.kind == MixKind::height ? -kWorldLimit : 0;
    out.low = number(lowest, kWorldLimit - 1, kWhat);
    sign("..");
    if (peek().kind == PatternTokenKind::number && peek().number <= out.low)
      return expected("a number above " + std::to_string(out.low));
    out.high = number(lowest, kWorldLimit - 1, kWhat);
  }
  bool is_name() const {
    return peek().kind == PatternTokenKind::quoted ||
           (peek().kind == PatternTokenKind::word && !is_pattern_keyword(peek().raw));
  }
  NamedMaterial name(std::string_view what) {
    if (!is_name()) {
      expected(what);
      return {};
    }
    const PatternToken& token = peek();
    NamedMaterial out{token.kind == PatternTokenKind::quoted ? token.name : std::string(token.raw),
                      token.column};
    if (out.name.empty() || out.name.size() > kMaterialNameBytesMax) {
      fail_at(token.column, "the name of a material has 1 to 64 bytes");
      return out;
    }
    skip();
    return out;
  }
  /// Returns true if parentheses may nest one deeper.
  bool may_nest(std::uint32_t depth) {
    if (depth < kPatternDepthMax) return true;
    fail_at(peek().column, "nested more than " + std::to_string(kPatternDepthMax) + " levels deep");
    return false;
  }

  Mix part(std::uint32_t depth, bool is_gradient, const std::vector<Mix>& before) {
    std::int32_t weight = 0;
    const bool has_weight = peek().kind == PatternTokenKind::number;
    if (has_weight && (is_gradient || (!before.empty() && before.front().weight == 0))) {
      expected("a material without a weight");
    } else if (!has_weight && !before.empty() && before.front().weight != 0) {
      expected("a weight");
    } else if (has_weight) {
      weight = number(1, kMixWeightMax, "a weight from 1 to 10000");
      sign("%");
    }
    Mix out;
    if (takes_sign("(")) {
      if (may_nest(depth)) out = mix(depth + 1);
      sign(")");
    } else {
      out.material = name("a material");
    }
    out.weight = weight;
    return out;
  }

  /// Reads operands with a word between them. One operand is returned as it is; the parts of an
  /// operand of the same kind, which stood in parentheses, become parts of the whole.
  template <class F>
  VoxelFilter joined(FilterKind kind, std::string_view word, F&& operand) {
    VoxelFilter out = operand();
    if (!is_word(word)) return out;
    VoxelFilter whole;
    whole.kind = kind;
    add_operand(whole, std::move(out));
    while (takes_word(word)) add_operand(whole, operand());
    return whole;
  }
  static void add_operand(VoxelFilter& whole, VoxelFilter operand) {
    if (operand.kind != whole.kind) return whole.parts.push_back(std::move(operand));
    std::move(operand.parts.begin(), operand.parts.end(), std::back_inserter(whole.parts));
  }

  VoxelFilter condition(std::uint32_t depth) {
    VoxelFilter out;
    if (takes_word("not")) {
      out.kind = FilterKind::negation;
      if (may_nest(depth)) out.parts.push_back(condition(depth + 1));
    } else if (takes_sign("(")) {
      if (may_nest(depth)) out = filter(depth + 1);
      sign(")");
    } else if (takes_word("is")) {
      out = materials(FilterKind::is);
    } else if (takes_word("on")) {
      out = materials(FilterKind::on);
    } else if (takes_word("under")) {
      out = materials(FilterKind::under);
    } else if (takes_word("beside")) {
      out = materials(FilterKind::beside);
    } else if (takes_word("exposed")) {
      out.kind = FilterKind::exposed;
    } else if (takes_word("solid")) {
      out.kind = FilterKind::solid;
    } else if (is_word("above") || is_word("below")) {
      out.kind = is_word("above") ? FilterKind::above : FilterKind::below;
      skip();
      out.number = number(-kWorldLimit, kWorldLimit - 1, "a height within the world");
    } else if (takes_word("noise")) {
      out.kind = FilterKind::noise;
      out.number = number(0, 100, "a percentage from 0 to 100");
      sign("%");
      const bool has_size = peek().kind == PatternTokenKind::number;
      out.size = has_size ? number(1, kClumpSizeMax, "a size from 1 to 256") : 1;
    } else {
      expected(
          "a condition: is, on, under, beside, exposed, solid, above, below, noise, not or \"(\"");
    }
    return out;
  }
  VoxelFilter materials(FilterKind kind) {
    VoxelFilter out;
    out.kind = kind;
    out.materials.push_back(name("a material"));
    // Behind `or`, a name goes on with the list, and anything else is another condition.
    while (is_word("or") && next_ + 1 < tokens_.size()) {
      ++next_;
      if (!is_name()) {
        --next_;
        break;
      }
      out.materials.push_back(name("a material"));
    }
    return out;
  }

  const std::vector<PatternToken>& tokens_;
  std::size_t next_ = 0;
  std::optional<PatternError> error_;
};

template <class T, class F>
Result<T, PatternError> parse_whole(std::string_view text, F&& rule) {
  const auto tokens = pattern_tokens(text);
  if (!tokens) return failure(tokens.error());
  PatternParser parser(*tokens);
  T out = rule(parser);
  if (const auto& error = parser.error()) return failure(*error);
  if (text_of(out).size() > kPatternBytesMax) {
    return failure(PatternError{1, "with its blanks the text has more than " +
                                       std::to_string(kPatternBytesMax) + " bytes"});
  }
  return out;
}

}  // namespace

Result<Pattern, PatternError> parse_pattern(std::string_view text) {
  return parse_whole<Pattern>(text, [](PatternParser& parser) { return parser.pattern(); });
}

Result<Mix, PatternError> parse_mix(std::string_view text) {
  return parse_whole<Mix>(text, [](PatternParser& parser) { return parser.whole_mix(); });
}

Result<VoxelFilter, PatternError> parse_filter(std::string_view text) {
  return parse_whole<VoxelFilter>(text,
                                  [](PatternParser& parser) { return parser.whole_filter(); });
}

}  // namespace runstone
