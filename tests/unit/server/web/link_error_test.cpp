#include "server/web/link_error.hpp"

#include <catch2/catch.hpp>
#include <cerrno>
#include <string>

using namespace runstone;

namespace {

WebClose close_for(int number) {
  return close_for_link_error({number, boost::system::system_category()});
}

}  // namespace

TEST_CASE("each reason why there is no server has words of its own", "[web]") {
  using Code = boost::beast::websocket::close_code;
  for (const int number : {ENOENT, ECONNREFUSED, ECONNRESET, EMFILE, ENOMEM, ENOBUFS, EACCES}) {
    CAPTURE(number);
    const WebClose close = close_for(number);
    CHECK(std::string(close.words).size() <= 123);  // RFC 6455, 5.5
    CHECK(close.code == (number == EACCES ? Code::internal_error : Code::try_again_later));
  }
  const auto words = [](int number) { return std::string(close_for(number).words); };
  CHECK(words(ENOENT).find("not running") != std::string::npos);
  CHECK(words(ENOENT) == words(ECONNREFUSED));
  CHECK(words(EMFILE).find("no room") != std::string::npos);
  CHECK(words(EMFILE) == words(ENFILE));
  CHECK(words(EACCES).find("tell its host") != std::string::npos);
  CHECK(words(ENOBUFS).find("many players") != std::string::npos);
}
