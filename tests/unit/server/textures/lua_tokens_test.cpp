// Words of Lua: texts, comments, and texts that are not well formed.
#include "server/textures/lua_tokens.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace runstone::test {
namespace {

std::string words_of(std::string_view text) {
  LuaTokens tokens(text);
  std::string out;
  for (LuaToken t = tokens.next(); t.kind != LuaToken::Kind::end; t = tokens.next()) {
    out += t.kind == LuaToken::Kind::text ? "'" + t.text + "'" : t.text;
    out += ' ';
  }
  return out;
}

}  // namespace

TEST_CASE("Lua is cut into words", "[textures]") {
  CHECK(words_of("a.b_1 = {\"x\\\"y\", 'z'} -- end\n..") == "a . b_1 = { 'x\"y' , 'z' } .. ");
  CHECK(words_of("--[[ no\n\"no\" ]] f [[a\"b]] [==[c]]d]==]") == "f 'a\"b' 'c]]d' ");
  CHECK(words_of("\"open\nnext") == "'open' next ");
  CHECK(words_of("[[open") == "'open' ");
  CHECK(words_of("--[==[ open").empty());
  CHECK(words_of("\"\\") == "'' ");
  CHECK(words_of(std::string_view("\0a\xff", 3)) == "a \xff ");
}

}  // namespace runstone::test
