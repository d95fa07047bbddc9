#include "client/play/server_notices.hpp"

#include <catch2/catch.hpp>

namespace runstone::test::server_notices_test {

TEST_CASE("the notice of a rejected edit shows no hidden characters", "[client]") {
  RejectedEdit reject;
  reject.reason = RejectReason::bad_edit;
  reject.detail =
      "a\xe2\x80\xae"
      "b";
  const PlayerNotice notice = notice_of(reject);
  CHECK(notice.kind == NoticeKind::warning);
  CHECK(notice.text ==
        std::string("the server refused an edit: ") + to_string(reject.reason) + " a?b");
}

}  // namespace runstone::test::server_notices_test
