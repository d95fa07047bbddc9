#include "common/patterns/pattern_tokens.hpp"

#include <charconv>
#include <utility>

#include "common/core/text.hpp"

namespace runstone {
namespace {

constexpr std::size_t kDigitsMax = 9;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

class PatternLexer {
 public:
  explicit PatternLexer(std::string_view text) : text_(text) {}

  Result<std::vector<PatternToken>, PatternError> run() {
    std::vector<PatternToken> out;
    for (;;) {
      while (at_ < text_.size() && text_[at_] == ' ') ++at_;
      PatternToken token;
      token.column = column();
      if (at_ == text_.size()) {
        out.push_back(std::move(token));
        return out;
      }
      const char* const why = read(token);
      if (why != nullptr) return failure(PatternError{token.column, why});
      out.push_back(std::move(token));
    }
  }

 private:
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  /// Returns the column of the next character. Requires that it is called in ascending order.
  std::uint32_t column() {
    for (; counted_ < at_; ++counted_) {
      if ((text_[counted_] & 0xC0) != 0x80) ++column_;  // else it continues a character of UTF-8
    }
    return column_;
  }
  /// Reads a token. Returns what is wrong with it, or null.
  const char* read(PatternToken& token) {
    const std::size_t first = at_;
    const char* why = nullptr;
    if (is_bare_name_character(peek(), true)) {
      token.kind = PatternTokenKind::word;
      while (at_ < text_.size() && is_bare_name_character(peek(), false)) ++at_;
    } else if (is_digit(peek()) || (peek() == '-' && is_digit(peek(1)))) {
      why = read_number(token);
    } else if (peek() == '"') {
      why = read_name(token);
    } else {
      token.kind = PatternTokenKind::sign;
      at_ += peek() == '.' && peek(1) == '.' ? 2 : 1;
    }
    token.raw = text_.substr(first, at_ - first);
    return why;
  }
  const char* read_number(PatternToken& token) {
    token.kind = PatternTokenKind::number;
    const std::size_t first = at_;
    if (peek() == '-') ++at_;
    const std::size_t first_digit = at_;
    while (is_digit(peek())) ++at_;
    if (at_ - first_digit > kDigitsMax) return "a number has at most nine digits";
    std::from_chars(text_.data() + first, text_.data() + at_, token.number);
    return nullptr;
  }
  const char* read_name(PatternToken& token) {
    token.kind = PatternTokenKind::quoted;
    for (++at_; at_ < text_.size(); ++at_) {
      if (peek() == '"') {
        ++at_;
        return nullptr;
      }
      if (peek() == '\\' && (peek(1) == '"' || peek(1) == '\\')) ++at_;
      token.name += peek();
    }
    return "the name has no closing quote";
  }

  const std::string_view text_;
  std::size_t at_ = 0, counted_ = 0;
  std::uint32_t column_ = 1;
};

}  // namespace

Result<std::vector<PatternToken>, PatternError> pattern_tokens(std::string_view text) {
  if (text.size() > kPatternBytesMax) {
    return failure(
        PatternError{1, "the text has more than " + std::to_string(kPatternBytesMax) + " bytes"});
  }
  if (!is_printable_utf8(text))
    return failure(PatternError{1, "the text is not UTF-8, or has control characters"});
  return PatternLexer(text).run();
}

}  // namespace runstone
