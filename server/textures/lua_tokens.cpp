#include "server/textures/lua_tokens.hpp"

#include <algorithm>

namespace runstone {
namespace {

bool is_name_byte(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

bool LuaTokens::take_long(std::string& out) {
  if (at_ >= text_.size() || text_[at_] != '[') return false;
  std::size_t open = at_ + 1;
  while (open < text_.size() && text_[open] == '=') ++open;
  if (open >= text_.size() || text_[open] != '[') return false;
  const std::string close = "]" + std::string(open - at_ - 1, '=') + "]";
  const std::size_t end = std::min(text_.find(close, open + 1), text_.size());
  out = text_.substr(open + 1, end - open - 1);
  at_ = std::min(end + close.size(), text_.size());
  return true;
}

void LuaTokens::pass_blanks() {
  for (;;) {
    while (at_ < text_.size() && static_cast<unsigned char>(text_[at_]) <= ' ') ++at_;
    if (text_.substr(at_, 2) != "--") return;
    at_ += 2;
    std::string comment;
    if (!take_long(comment)) at_ = std::min(text_.find('\n', at_), text_.size());
  }
}

LuaToken LuaTokens::take_quoted() {
  const char quote = text_[at_++];
  LuaToken out{LuaToken::Kind::text, {}};
  while (at_ < text_.size() && text_[at_] != quote && text_[at_] != '\n') {
    if (text_[at_] == '\\') ++at_;
    if (at_ < text_.size()) out.text += text_[at_++];
  }
  if (at_ < text_.size()) ++at_;
  return out;
}

LuaToken LuaTokens::next() {
  pass_blanks();
  if (at_ >= text_.size()) return {};
  const char c = text_[at_];
  if (c == '"' || c == '\'') return take_quoted();
  LuaToken out{LuaToken::Kind::text, {}};
  if (take_long(out.text)) return out;
  const std::size_t begin = at_;
  if (is_name_byte(c)) {
    while (at_ < text_.size() && is_name_byte(text_[at_])) ++at_;
    return {LuaToken::Kind::name, std::string(text_.substr(begin, at_ - begin))};
  }
  at_ += text_.substr(at_, 2) == ".." ? 2 : 1;
  return {LuaToken::Kind::sign, std::string(text_.substr(begin, at_ - begin))};
}

}  // namespace runstone
