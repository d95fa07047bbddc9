#include "client/stream/receive_ack_scheduler.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

TEST_CASE("the first bytes are acknowledged at once, later ones by time or by bytes",
          "[client_net]") {
  ReceiveAckScheduler report;
  CHECK_FALSE(report.due(0).has_value());
  CHECK(report.is_due(1, 5'000'000));
  report.sent(1, 5'000'000);
  CHECK_FALSE(report.due(1).has_value());  // no new bytes
  CHECK_FALSE(report.is_due(2, 5'000'000 + kReceiveAckEveryUs - 1));
  CHECK(report.is_due(2, 5'000'000 + kReceiveAckEveryUs));
  CHECK(report.is_due(1 + kReceiveAckEveryBytes, 5'000'000 + kReceiveAckUsMin));
  CHECK_FALSE(report.is_due(1 + kReceiveAckEveryBytes,
                            5'000'000 + kReceiveAckUsMin - 1));  // not more often
}

}  // namespace
}  // namespace runstone
